/// crane bench fleet: several moving cranes on this computer: lost ticks, processor time, memory, start-up.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands/bench.hpp"
#include "cli/fleet.hpp"
#include "cli/number_range.hpp"
#include "cli/text_table.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

struct FleetOptions {
  runtime::BusOptions bus;
  std::string rig = stack::kDefaultRig;
  int cranes = 4;
  int viewers = 0;
  double seconds = 60;
  bool in_process = false, one_by_one = false, own_domains = false, json = false;
};

/// Result of one crane, from the time at which all cranes moved to the end.
struct CraneResult {
  std::string name;
  std::optional<double> start_up_s;
  double loop_us = 0, other_us = 0;  ///< processor time per tick
  CraneUse end;
  std::uint64_t lost_ticks = 0;
  int moves = 0;
};

class FleetRun {
 public:
  explicit FleetRun(const FleetOptions& options)
      : options_{options},
        rig_{configuration::load_rig(stack::find_rig(options.rig).string())},
        prefix_{"fleet_" + std::to_string(::getpid()) + "_"},
        directory_{std::filesystem::temp_directory_path() / prefix_} {
    std::filesystem::create_directories(directory_);
    for (int i = 0; i < (options_.own_domains ? options_.cranes : 1); ++i) {
      auto bus = bus_of(i);
      bus.crane = prefix_;
      fleets_.emplace_back(bus, rig_);
    }
  }
  ~FleetRun() {
    children_.stop(std::chrono::seconds{10});
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }
  FleetRun(const FleetRun&) = delete;
  FleetRun& operator=(const FleetRun&) = delete;

  std::vector<CraneResult> measure() {
    start();
    for (int i = 0; i < options_.viewers; ++i) start_viewer(i);
    for (auto& fleet : fleets_) fleet.operate();
    wait_for("accepted no move", [](const FleetCrane& crane) { return crane.moves > 0; });
    const auto before = cranes();
    std::vector<CraneUse> use;
    for (const auto& crane : before) use.push_back(use_of(crane.pid));
    const auto begin_ns = runtime::monotonic_ns();
    (void)wait_until([] { return false; }, options_.seconds);
    const double ticks = static_cast<double>(runtime::monotonic_ns() - begin_ns) * 1e-9 / rig_.period_s;
    std::vector<CraneResult> results;
    for (std::size_t i = 0; const auto& crane : cranes())
      results.push_back(result(before[i], use[i], crane, ticks)), ++i;
    return results;
  }

 private:
  static constexpr double kPatience_s = 60;  // longest wait for all cranes to start, and to move

  static CraneResult result(const FleetCrane& before, const CraneUse& use, const FleetCrane& crane,
                            double ticks) {
    const auto end = use_of(crane.pid);
    return {.name = crane.name,
            .start_up_s = crane.start_up_s,
            .loop_us = static_cast<double>(end.loop_ns - use.loop_ns) / 1e3 / ticks,
            .other_us = static_cast<double>(end.other_ns - use.other_ns) / 1e3 / ticks,
            .end = end,
            .lost_ticks = crane.lost_ticks() - before.lost_ticks(),
            .moves = crane.moves - before.moves};
  }

  [[nodiscard]] std::vector<FleetCrane> cranes() const {
    std::vector<FleetCrane> all;
    for (const auto& fleet : fleets_) all.insert(all.end(), fleet.cranes().begin(), fleet.cranes().end());
    return all;
  }

  [[nodiscard]] runtime::BusOptions bus_of(int crane) const {
    auto bus = options_.bus;
    bus.crane = prefix_ + std::to_string(crane + 1);
    if (options_.own_domains) bus.domain += static_cast<std::uint32_t>(crane);
    return bus;
  }

  void start() {
    for (int i = 0; i < options_.cranes; ++i) {
      const auto bus = bus_of(i);
      auto arguments = runtime::arguments(bus);
      arguments.insert(arguments.begin(),
                       {"up", "--rig", rig_.path, "--black-box", (directory_ / bus.crane).string()});
      if (options_.in_process) arguments.emplace_back("--in-process");
      children_.start(bus.crane, "crane", arguments);
      fleets_[options_.own_domains ? static_cast<std::size_t>(i) : 0].add(bus.crane,
                                                                          *children_.pid_of(bus.crane));
      if (options_.one_by_one) wait_for_start_up();
    }
    wait_for_start_up();
  }

  void wait_for_start_up() {
    wait_for("not ready", [](const FleetCrane& crane) { return crane.start_up_s.has_value(); });
  }

  /// A viewer is a program that receives all topics of a crane.
  void start_viewer(int number) {
    auto bus = bus_of(number % options_.cranes);
    bus.vendor = "fastdds";
    auto arguments = runtime::arguments(bus);
    arguments.insert(arguments.begin(), {"record", "/dev/null", "--force"});
    children_.start("viewer " + std::to_string(number + 1), "crane", arguments);
  }

  /// Waits until `condition` is true for every crane. @throws std::runtime_error that names the cranes for
  /// which it is false
  template <class Condition>
  void wait_for(const std::string& problem, const Condition& condition) {
    if (wait_until([&] { return std::ranges::all_of(cranes(), condition); }, kPatience_s)) return;
    std::string names;
    for (const auto& crane : cranes())
      if (!condition(crane)) names += (names.empty() ? "" : ", ") + crane.name;
    throw std::runtime_error(problem + " within " + fixed(kPatience_s, 0) + " s: " + names);
  }

  /// Operates the cranes until `condition` is true. @return false at the timeout `patience_s`
  template <class Condition>
  bool wait_until(const Condition& condition, double patience_s) {
    const auto deadline_ns = runtime::monotonic_ns() + static_cast<std::int64_t>(patience_s * 1e9);
    for (;;) {
      for (auto& fleet : fleets_) fleet.poll();
      if (condition()) return true;
      if (runtime::monotonic_ns() > deadline_ns) return false;
      if (runtime::stop_requested()) throw std::runtime_error("interrupted");
      if (const auto ended = children_.ended()) throw std::runtime_error(stack::describe(*ended));
      ::usleep(20'000);
    }
  }

  FleetOptions options_;
  configuration::Rig rig_;
  std::string prefix_;
  std::filesystem::path directory_;  ///< of the black boxes
  stack::ChildProcesses children_;
  std::deque<Fleet> fleets_;  ///< one per domain
};

nlohmann::ordered_json to_json(const CraneResult& crane) {
  return {{"crane", crane.name},
          {"start_up_s", crane.start_up_s.value_or(-1)},
          {"processes", crane.end.processes},
          {"loop_us", crane.loop_us},
          {"other_us", crane.other_us},
          {"memory_mb", crane.end.memory_mb},
          {"moves", crane.moves},
          {"lost_ticks", crane.lost_ticks}};
}

void print(const std::vector<CraneResult>& cranes) {
  TextTable table{{"crane", "start-up s", "processes", "loop us/tick", "others us/tick", "memory MB", "moves",
                   "lost ticks"}};
  for (const auto& crane : cranes)
    table.add({crane.name, fixed(crane.start_up_s.value_or(-1), 2), std::to_string(crane.end.processes),
               fixed(crane.loop_us, 0), fixed(crane.other_us, 0), fixed(crane.end.memory_mb, 1),
               std::to_string(crane.moves), std::to_string(crane.lost_ticks)});
  table.print(std::cout);
}

int bench_fleet(const FleetOptions& options) {
  runtime::install_stop_signals();
  FleetRun run{options};
  const auto cranes = run.measure();
  if (options.json) {
    auto json = nlohmann::ordered_json::array();
    for (const auto& crane : cranes) json.push_back(to_json(crane));
    std::cout << json.dump(2) << '\n';
  } else {
    print(cranes);
  }
  return runtime::kExitDone;
}

}  // namespace

void add_bench_fleet(CLI::App& bench, Action& chosen) {
  auto options = std::make_shared<FleetOptions>();
  auto* command = bench.add_subcommand(
      "fleet", "Run several moving cranes: lost ticks, processor time, memory and start-up time of each");
  command->add_option("--cranes", options->cranes, "number of cranes")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--viewers", options->viewers, "number of programs that receive all topics of a crane")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  command->add_flag("--in-process", options->in_process,
                    "one process per control loop: crane up --in-process");
  command->add_flag("--one-by-one", options->one_by_one,
                    "start each crane after the previous crane is ready");
  command->add_flag("--own-domains", options->own_domains,
                    "one domain per crane, from --domain on; default: all cranes in one domain");
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  command
      ->add_option("--seconds", options->seconds, "duration in s, from the first move of the last crane on")
      ->check(number_in(1.0, 86400.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print as JSON");
  runtime::add_bus_options(*command, options->bus);
  command->footer("Example: crane bench fleet --cranes 16 --in-process --seconds 300 (docs/fleet.md)");
  command->callback([options, &chosen] { chosen = [options] { return bench_fleet(*options); }; });
}

}  // namespace crane::cli
