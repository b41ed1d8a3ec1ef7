#include "dashboard/dashboard.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/system/system_error.hpp>
#include <iostream>
#include <thread>

#include "crane/configuration/rig.hpp"
#include "crane/runtime/command_line.hpp"
#include "crane/runtime/program_start.hpp"
#include "dashboard/request_queue.hpp"
#include "dashboard/rig_text.hpp"
#include "dashboard/server.hpp"
#include "dashboard/token_file.hpp"
#include "observation/observer.hpp"
#include "stack/data_files.hpp"

namespace crane::dashboard {
namespace {

/// Nice value that keeps a busy dashboard from delaying a control loop without real-time priority.
constexpr int kNiceness = 10;

void check_address(const std::string& listen) {
  boost::system::error_code error;
  boost::asio::ip::make_address(listen, error);
  if (error)
    throw configuration::ConfigurationError({"--listen " + listen + ": must be an address of this computer"});
}

std::unique_ptr<Server> open_server(const Options& options, About about, AccessRules rules,
                                    std::function<void(const stack::OperatorRequest&, Answered)> send) {
  const RunsOptions runs{.program = stack::program_directory() / "crane",
                         .directory = options.runs,
                         .rig = options.rig.empty() ? "" : stack::find_rig(options.rig).string()};
  try {
    return std::make_unique<Server>(options.listen, options.port, std::move(about), std::move(rules),
                                    std::move(send), runs);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error("dashboard: cannot open " + address_of(options.listen, options.port) + ": " +
                             error.code().message() + "; choose another --port or --listen");
  }
}

}  // namespace

Options default_options() {
  Options options;
  options.bus.vendor = "fastdds";  // as for all tools, so that every run uses both vendors
  return options;
}

void add_options(CLI::App& app, Options& options) {
  app.add_option(
         "--listen", options.listen,
         "address to serve on; with 0.0.0.0 (every address), anyone who can reach this computer may watch")
      ->capture_default_str();
  app.add_option("--port", options.port, "TCP port for page, viewers, /api and /metrics; 0: any free port")
      ->capture_default_str();
  app.add_option("--operator-token", options.token_file,
                 "file with the token that operators must enter, also on this computer; created if it "
                 "does not exist");
  app.add_flag("--read-only", options.read_only, "refuse every operation");
  app.add_option("--host-name", options.host_names,
                 "permit browsers to open this dashboard under this host name, in addition to addresses and "
                 "localhost (repeatable)");
  app.add_option(
      "--allow-origin", options.other_origins,
      "permit another page with this origin to watch, for example https://app.foxglove.dev (repeatable)");
  app.add_option("--rig", options.rig, "rig file or name; the page then draws soft limits and planned paths");
  app.add_option("--runs", options.runs,
                 "directory of recordings that the page lists, compares and diagnoses")
      ->check(CLI::ExistingDirectory);
  app.add_option("--parent", options.parent, "process id that this process ends with")->group("");
  runtime::add_bus_options(app, options.bus);
}

std::string address_of(const std::string& listen, unsigned short port) {
  const auto shown = listen == "0.0.0.0" ? std::string{"localhost"} : listen;
  const bool six = shown.find(':') != std::string::npos;
  return "http://" + (six ? "[" + shown + "]" : shown) + ":" + std::to_string(port) + "/";
}

int run(const Options& options) {
  runtime::install_stop_signals();
  ::setpriority(PRIO_PROCESS, 0, kNiceness);
  if (options.parent != 0) runtime::end_with_parent(options.parent);
  check_address(options.listen);
  AccessRules rules{.token = options.token_file.empty() ? "" : read_or_make_token(options.token_file),
                    .host_names = options.host_names,
                    .other_origins = options.other_origins,
                    .read_only = options.read_only};
  About about{.version = CRANE_VERSION, .crane = options.bus.crane, .domain = options.bus.domain, .rig = ""};
  if (!options.rig.empty()) {
    const auto rig = configuration::load_rig(stack::find_rig(options.rig));
    about.rig = rig_text(rig);
    for (std::size_t i = 0; i < about.reference_acceleration.size(); ++i)
      about.reference_acceleration[i] = rig.drives[i].reference_acceleration;
  }

  const auto source = options.read_only ? crane_SOURCE_MONITOR : crane_SOURCE_OPERATOR;
  bus::Bus bus{runtime::bus_options(options.bus, "crane_dashboard", source, runtime::random_epoch())};
  std::unique_ptr<Server> server;
  observation::Observer observer{
      bus, [&server](std::vector<observation::SamplePtr> samples) { server->put(std::move(samples)); }};
  RequestQueue request_queue{bus, !options.read_only};
  server =
      open_server(options, std::move(about), std::move(rules),
                  [&server, &request_queue](const stack::OperatorRequest& wanted, const Answered& answered) {
                    const auto back = [&server, answered](Reply reply) {
                      server->post([answered, reply = std::move(reply)] { answered(reply); });
                    };
                    if (!request_queue.ask(wanted, back))
                      answered({false, "too many requests at once: try again"});
                  });
  std::cout << "dashboard: " << address_of(options.listen, server->port()) << std::endl;
  std::jthread network{[&server] { server->run(); }};
  constexpr std::int64_t kVersionsPeriod_ns = 1'000'000'000;
  for (std::int64_t due_ns = 0; !runtime::stop_requested();) {
    observer.poll();
    request_queue.poll();
    if (runtime::monotonic_ns() < due_ns) continue;
    due_ns = runtime::monotonic_ns() + kVersionsPeriod_ns;
    server->set_other_versions(bus.other_versions());
  }
  server->stop();
  return runtime::kExitDone;
}

void launch(stack::ChildProcesses& children, runtime::BusOptions bus, const std::string& rig,
            const std::string& runs, unsigned short port) {
  bus.vendor = default_options().bus.vendor;
  auto arguments = runtime::arguments(bus);
  arguments.insert(arguments.end(), {"--rig", rig, "--runs", runs, "--port", std::to_string(port), "--parent",
                                     std::to_string(::getpid())});
  children.start("dashboard", "crane_dashboard", arguments);
}

int main_of(int argc, char** argv) {
  runtime::start_program();
  CLI::App app{
      "Serves the dashboard of a crane: pages, live data for viewers, /api and /metrics on one port.",
      "crane_dashboard"};
  runtime::refuse_values_of_flags(app);
  auto options = default_options();
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return runtime::exit_code_of(app, error);
  }
  try {
    return run(options);
  } catch (const configuration::ConfigurationError& error) {
    std::cerr << error.what() << '\n';
    return runtime::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "crane_dashboard: " << error.what() << '\n';
    return runtime::kExitFailed;
  }
}

}  // namespace crane::dashboard
