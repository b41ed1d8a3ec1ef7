#include "black_box/black_box.hpp"

#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "black_box/incident_file.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/runtime/node.hpp"
#include "observation/observer.hpp"
#include "stack/data_files.hpp"

namespace crane::black_box {
namespace {

Origin origin_of(const Options& options) {
  utsname host{};
  ::uname(&host);
  Origin origin{.crane = {{"crane", options.bus.crane},
                          {"domain", std::to_string(options.bus.domain)},
                          {"version", CRANE_VERSION},
                          {"recorded_by", "black box"},
                          {"host", host.nodename},
                          {"kernel", std::string{host.sysname} + " " + host.release + " " + host.machine},
                          {"cores", std::to_string(std::thread::hardware_concurrency())},
                          {"log_time", "arrival, ns since 1970"},
                          {"publish_time", "writer's clock, ns since 1970"},
                          {"sequence", "tick"}},
                .rig_name = "",
                .rig_text = ""};
  if (options.rig.empty()) return origin;
  const auto file = stack::find_rig(options.rig);
  origin.rig_name = file.filename().string();
  origin.rig_text = configuration::file_text(file);
  return origin;
}

/// "tracking" -> "0.1.0, cyclone, delayed_1, process 4711, start 123456". The last number is the random
/// start-up number.
recording::Metadata processes_of(const observation::Traffic& traffic) {
  recording::Metadata processes;
  for (const auto& [number, heard] : traffic.nodes()) {
    const auto& node = heard.status;
    processes[node.name] = std::string{node.version} + ", " + node.vendor +
                           (*node.controller != 0 ? ", " + std::string{node.controller} : "") + ", process " +
                           std::to_string(node.pid) + ", start " + std::to_string(node.header.epoch);
  }
  return processes;
}

constexpr std::int64_t kLinger_ns = 200'000'000;

/// Writes in a separate thread, so that a slow disk delays no sample.
class Writer {
 public:
  Writer(const Options& options, Origin origin) : options_{options}, origin_{std::move(origin)} {}

  void write(Incident incident, recording::Metadata processes) {
    thread_ = std::jthread{[this, incident = std::move(incident), processes = std::move(processes)] {
      try {
        const auto file = write_incident(options_.directory, incident, origin_, processes);
        std::cout << "black box: " + file.string() + "\n" << std::flush;
        keep_newest(options_.directory, options_.files, file);
      } catch (const recording::WriteError& error) {
        std::cerr << "black box: " + std::string{error.what()} + "; free space or name another --out\n";
      }
    }};
  }

 private:
  const Options& options_;
  Origin origin_;
  std::jthread thread_;  ///< a new thread waits for the end of the previous one
};

/// Directory of this user beside those of others: a program without HOME and XDG_STATE_HOME uses it.
std::filesystem::path shared_base() {
  std::error_code error;  // without a temporary directory, the base does not exist
  return std::filesystem::temp_directory_path(error) / ("crane_" + std::to_string(::geteuid()));
}

/// True if the directory is in shared_base(), and another user has created shared_base() or made it a link:
/// the black box would delete the files in a directory of this user's choice.
bool planted(const std::filesystem::path& directory) {
  const auto base = shared_base();
  struct stat found {};
  return directory.parent_path() == base && ::lstat(base.c_str(), &found) == 0 &&
         (!S_ISDIR(found.st_mode) || found.st_uid != ::geteuid());
}

}  // namespace

std::filesystem::path default_directory() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state != nullptr && *state != 0) return std::filesystem::path{state} / "crane" / "black_box";
  if (home != nullptr && *home != 0)
    return std::filesystem::path{home} / ".local/state" / "crane" / "black_box";
  return shared_base() / "black_box";
}

Options default_options() {
  Options options;
  options.directory = default_directory();
  options.bus.vendor = "fastdds";  // as for all tools, so that every run uses both vendors
  return options;
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--out", options.directory, "directory of the recordings")->capture_default_str();
  app.add_option("--files", options.files, "number of recordings to keep; older recordings are deleted")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--rig", options.rig, "rig file or name to attach to each recording");
  app.add_option("--parent", options.parent, "process id that this process ends with")->group("");
  runtime::add_bus_options(app, options.bus);
}

int run(const Options& options) {
  runtime::install_stop_signals();
  if (options.parent != 0) runtime::end_with_parent(options.parent);
  const auto check_owner = [&options] {
    if (planted(options.directory))
      throw configuration::ConfigurationError(
          {"directory of the black box = " + options.directory.string() + ": " + shared_base().string() +
           " must be a directory of this user; set HOME, crane black-box --out or crane up --black-box"});
  };
  check_owner();
  std::error_code error;
  std::filesystem::create_directories(options.directory, error);
  check_owner();
  if (error || ::access(options.directory.c_str(), W_OK) != 0)
    throw configuration::ConfigurationError(
        {"directory of the black box = " + options.directory.string() +
         ": must be a directory in which this user can write; set it with "
         "crane black-box --out or crane up --black-box"});
  Writer writer{options, origin_of(options)};
  bus::Bus bus{
      runtime::bus_options(options.bus, "crane_black_box", crane_SOURCE_RECORDER, runtime::random_epoch())};
  Incidents incidents{observation::log_now_ns()};
  observation::Observer observer{bus, [&incidents](const std::vector<SamplePtr>& samples) {
                                   for (const auto& sample : samples) incidents.add(sample);
                                 }};
  const auto keep = [&](bool ends) {
    if (auto incident = incidents.poll(runtime::monotonic_ns(), observation::log_now_ns(), ends))
      writer.write(*std::move(incident), processes_of(incidents.traffic()));
  };
  while (!runtime::stop_requested()) {
    observer.poll();
    keep(false);
  }
  // Receives samples that are still in transit. The end of the other processes is not a fault; the end of
  // `crane up` before its processes is one. The kernel signals the end of a parent before getppid() shows it.
  const auto stop_ns = observation::log_now_ns();
  incidents.ignore_causes_after(stop_ns);
  while (observation::log_now_ns() < stop_ns + kLinger_ns) observer.poll();
  if (options.parent != 0 && ::getppid() != options.parent)
    incidents.add(
        {.at_ns = stop_ns,
         .from = "crane_up",
         .what = "STACK_KILLED",
         .explanation = "crane up ended before its processes, which then ended, too",
         .remedy = "look for the cause in the log of the system (no memory?), then start crane up again"});
  keep(true);
  return runtime::kExitDone;
}

}  // namespace crane::black_box
