/// crane top: processes, topics and state of a running crane as a table that refreshes.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/number_range.hpp"
#include "cli/terminal.hpp"
#include "cli/tool_bus.hpp"
#include "cli/top_model.hpp"
#include "cli/top_table.hpp"
#include "commands.hpp"
#include "observation/observer.hpp"

namespace crane::cli {
namespace {

struct TopOptions {
  bool once = false, json = false;
  double timeout_s = 5;
  runtime::BusOptions bus = tool_bus();
};

class Top {
 public:
  explicit Top(const TopOptions& options)
      : options_{options},
        bus_{open_bus(options.bus)},
        observer_{bus_, [this](std::vector<observation::SamplePtr> samples) {
                    for (const auto& sample : samples) model_.add(sample);
                  }} {}

  /// Prints one table or object as soon as every figure is known.
  int once() {
    const auto end_ns = runtime::monotonic_ns() + static_cast<std::int64_t>(options_.timeout_s * 1e9);
    while (!runtime::stop_requested() && !model_.complete() && runtime::monotonic_ns() < end_ns) update();
    if (!model_.state() && !model_.supervisor() && model_.traffic().nodes().empty())
      throw std::runtime_error("no sample received" + where_and_remedy(bus_));
    options_.json ? print_json() : print();
    return runtime::kExitDone;
  }

  /// Refreshes the view in place until q or a signal.
  int on_terminal() {
    Screen screen;
    TerminalSize shown{};
    while (!runtime::stop_requested() && !screen.quit_requested()) {
      const bool fresh = update();
      const auto size = terminal_size();
      if (!fresh && size.columns == shown.columns && size.rows == shown.rows) continue;
      shown = size;
      screen.show(text(size));
    }
    return runtime::kExitDone;
  }

  /// Prints one table after the other into a pipe, until a signal.
  int in_sequence() {
    while (!runtime::stop_requested())
      if (update() && model_.complete()) {
        print();
        std::cout << std::endl;
        if (!std::cout) return runtime::kExitFailed;
      }
    return runtime::kExitDone;
  }

 private:
  bool update() {
    observer_.poll();
    return model_.poll(runtime::monotonic_ns(), observation::log_now_ns());
  }
  [[nodiscard]] std::string title() const {
    return "crane '" + options_.bus.crane + "'  domain " + std::to_string(options_.bus.domain);
  }
  [[nodiscard]] std::string text(const std::optional<TerminalSize>& size) {
    const bool heard = model_.state() || model_.supervisor() || !model_.traffic().nodes().empty();
    if (!heard) return title() + "\nno sample received yet" + where_and_remedy(bus_) + "\nq ends\n";
    return top_text(model_, {.title = title(), .size = size, .trends = size.has_value()},
                    runtime::monotonic_ns(), observation::log_now_ns());
  }
  void print() { std::cout << text(std::nullopt); }
  void print_json() {
    nlohmann::ordered_json result{{"crane", options_.bus.crane}, {"domain", options_.bus.domain}};
    result.update(model_.json(runtime::monotonic_ns()));
    std::cout << result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  }

  const TopOptions& options_;
  bus::Bus bus_;
  TopModel model_;
  observation::Observer observer_;
};

int top(const TopOptions& options) {
  Top view{options};
  if (options.once || options.json) return view.once();
  return output_is_terminal() ? view.on_terminal() : view.in_sequence();
}

}  // namespace

void add_top(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<TopOptions>();
  auto* command =
      app.add_subcommand("top", "Show processes, topics and state as a table that refreshes every second");
  command->add_flag("--once", options->once, "print one table and end");
  command->add_flag("--json", options->json, "print one JSON object and end");
  command
      ->add_option("--timeout", options->timeout_s,
                   "with --once or --json: longest wait in s for two reports of every process")
      ->check(positive_number())
      ->capture_default_str();
  runtime::add_bus_options(*command, options->bus);
  command->footer(
      "Examples: crane top\n"
      "          crane top --once\n"
      "          crane top --json | jq '.topics[] | {topic, rate_hz, delay_us}'\n"
      "q or Ctrl-C ends the view. A narrow terminal shows the most important columns.\n"
      "Delay is the time from the latching of the encoders to the sending of the sample, in the last\n"
      "second. It is shown when bridge and writer run on the same host. ticks/s is the rate between the\n"
      "last two reports of the process. Counts begin when this command starts.");
  command->callback([options, &chosen] { chosen = [options] { return top(*options); }; });
}

}  // namespace crane::cli
