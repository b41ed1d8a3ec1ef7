// The twin as a process beside a stack of processes in lockstep: its event for a crane that differs from its
// rig file, equal to that in one process.
#include <gtest/gtest.h>
#include <unistd.h>

#include "../recording/temporary_directory.hpp"
#include "crane/experiment/variant.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/twin/component.hpp"
#include "experiments/experiment_run.hpp"
#include "experiments/lockstep_run.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"

namespace crane::test {
namespace {

using recording::contents_of;
using recording::TemporaryDirectory;

constexpr std::uint32_t kDomain = 72;

/// Moves in both directions, enough for learning and tests.
std::string scenario_text(int moves) {
  std::string text = "description = \"to and fro\"\nduration_s = " + std::to_string(5 * moves) + "\n";
  for (int i = 0; i < moves; ++i)
    text += "[[move]]\nat_s = " + std::to_string(5 * i) +
            ".2\ntrolley_position_m = " + (i % 2 == 0 ? "0.9" : "0.4") +
            "\nslew_angle_deg = " + (i % 3 == 0 ? "60" : "-20") + "\n";
  return text;
}

class TwinProcess : public testing::Test {
 protected:
  /// Runs the scenario with processes over DDS; the plant is `variant` of the twin's rig.
  void run(const std::string& variant, int moves) {
    const auto rig_file = stack::find_rig("virginia_tech_tower");
    const auto rig = configuration::load_rig(rig_file);
    recording::put_contents(directory_ / "moves.toml", scenario_text(moves));
    const auto scenario = experiment::load_scenario(directory_ / "moves.toml", &rig);
    const auto started = experiment::changed_by(experiment::with_start_of(rig, scenario), variant);
    const std::string mass = "load_mass_kg = 2.0";
    auto changed = contents_of(rig_file);
    if (!variant.empty())
      changed.replace(changed.find(mass), mass.size(),
                      "load_mass_kg = " + std::to_string(started.plant.load_mass_kg));
    recording::put_contents(directory_ / "plant.toml", changed);

    stack::LaunchOptions options;
    options.rig = (directory_ / "plant.toml").string();
    options.clock = "lockstep";
    options.epoch = 1;
    options.bus.domain = kDomain;
    options.bus.crane = "twin_test_" + std::to_string(::getpid());
    auto specs = stack::simulated_stack();
    stack::ChildProcesses children;
    stack::launch(children, specs, options);
    stack::launch_twin(children, rig_file.string(), options);
    specs.push_back(twin::twin_spec());
    bus::Bus bus{runtime::bus_options(options.bus, "twin_test", crane_SOURCE_OPERATOR, 1)};
    auto events = bus.subscriber(topics::event);
    auto twins = bus.subscriber(topics::twin, runtime::loop_endpoint(runtime::Clock::lockstep));
    stack::wait_until_ready(children, specs, bus, std::chrono::seconds{15});
    experiments::TickLog log{std::nullopt};
    const experiments::Pump pump = [&] {
      bus.wait(std::chrono::milliseconds{5});
      while (const auto event = events.take()) events_.push_back(*event);
      while (const auto twin = twins.take()) twins_.push_back(*twin);
    };
    const auto outcome = experiments::run_scenario(bus, pump, started, scenario, log, specs);
    pump();
    EXPECT_TRUE(outcome.completed) << outcome.stopped_because;
    children.stop();
  }
  [[nodiscard]] std::vector<std::string> codes() const {
    std::vector<std::string> codes;
    for (const auto& event : events_)
      if (std::string{event.node} == "twin") codes.emplace_back(event.code);
    return codes;
  }

  TemporaryDirectory directory_;
  std::vector<msg::Event> events_;
  std::vector<msg::Twin> twins_;
};

TEST_F(TwinProcess, ReportsAPayloadThatDiffersFromItsRigFile) {
  run("heavy_load", 8);
  EXPECT_EQ(codes(), std::vector<std::string>{"twin_deviates"});
  ASSERT_FALSE(twins_.empty());
  EXPECT_EQ(twins_.back().state, crane_TWIN_DEVIATES);
  EXPECT_STREQ(twins_.back().cause, "payload_mass");
  EXPECT_NEAR(twins_.back().size, 1.0, 0.33);
}

TEST_F(TwinProcess, ReportsNothingForTheCraneOfItsRigFile) {
  run("", 6);
  EXPECT_TRUE(codes().empty());
  ASSERT_FALSE(twins_.empty());
  EXPECT_EQ(twins_.back().state, crane_TWIN_WATCHING);
  for (std::size_t k = 1; k < twins_.size(); ++k)
    ASSERT_EQ(twins_[k].header.tick, twins_[k - 1].header.tick + 1) << "every tick once";
}

TEST_F(TwinProcess, GivesTheSameRecordingInOneProcessAsInSeparateProcesses) {
  recording::put_contents(directory_ / "moves.toml", scenario_text(1));
  experiments::ExperimentOptions options;
  options.scenario = directory_ / "moves.toml";
  options.rig = stack::find_rig("virginia_tech_tower");
  options.twin = options.rig;
  options.picture = false;
  options.bus.domain = kDomain;
  options.in_process = true;
  options.directory = directory_ / "one";
  (void)experiments::run_experiment(options);
  options.in_process = false;
  options.directory = directory_ / "many";
  (void)experiments::run_experiment(options);
  EXPECT_TRUE(contents_of(directory_ / "one" / "recording.mcap") ==
              contents_of(directory_ / "many" / "recording.mcap"));
}

}  // namespace
}  // namespace crane::test
