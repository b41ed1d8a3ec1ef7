// A run in real time, in which processes are late or paused, is replayed bit for bit: the recording states
// which process stepped in which tick, and with which inputs.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <random>
#include <set>

#include "../recording/temporary_directory.hpp"
#include "campaign/virtual_stack.hpp"
#include "crane/recording/mcap_writer.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/runtime/process.hpp"
#include "experiments/rig_at_start_file.hpp"
#include "replay/replay.hpp"
#include "stack/operator_client.hpp"
#include "stack/stack.hpp"

namespace crane::replay_test {
namespace {

/// A stack in real time, in virtual time, and a recording with the times of publication.
class LateStack {
 public:
  LateStack(const std::filesystem::path& file, const std::string& rig, const std::string& controller)
      : rig_{configuration::load_rig(std::string{CRANE_RIGS "/"} + rig + ".toml")},
        controller_{runtime::chosen_controller(controller, rig_)},
        writer_{file},
        channels_{recording::add_topic_channels(writer_)},
        stack_{specs(), rig_, controller_, nullptr},
        bus_{runtime::memory_options(stack_.network(), "operator", crane_SOURCE_OPERATOR)},
        operator_{bus_, "operator", 1},
        jogs_{bus_.publisher(topics::jog)} {
    writer_.metadata("crane", {{"crane", "late"}});
    const auto text = experiments::rig_at_start_text(rig_);
    writer_.attachment("rig.toml", "application/toml", 0,
                       {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    bus::set_wire(*stack_.network(),
                  [this](const auto& topic, const void* sample, const bus::Deliver& deliver) {
                    record(topic, sample);
                    if (!loses_statuses_ || topic.name != topics::supervisor.description.name)
                      deliver(sample);
                  });
  }
  void run(double seconds) { stack_.run_until(stack_.now_ns() + std::llround(seconds * 1e9)); }
  void suspend(crane_Source source, double seconds) {
    stack_.suspend(source, stack_.now_ns() + std::llround(seconds * 1e9));
  }
  void ask(stack::OperatorRequest wanted) {
    wanted.newest_status = newest_;
    last_id_ = operator_.send(wanted);
  }
  /// Deflects the stick of the session that was requested last, for one tick.
  void deflect(double slew, bool engaged = true) {
    msg::Jog jog{};
    jog.header.tick = newest_.tick;
    jog.request_id = last_id_;
    runtime::assign(jog.client, "operator");
    jog.engaged = engaged;
    jog.deflection[1] = slew;
    ASSERT_TRUE(jogs_.publish(jog));
    run(0.01);
  }
  /// The planner receives no status for one tick.
  void run_a_tick_without_status() {
    loses_statuses_ = true;
    run(0.01);
    loses_statuses_ = false;
  }
  /// The recorder misses the first sample of each topic that the supervisor writes.
  void miss_first_step() { misses_first_step_ = true; }
  /// From now on, the recorder misses what operators publish.
  void miss_operators(bool misses) { misses_operators_ = misses; }
  void close() { writer_.close(); }

 private:
  static const std::vector<runtime::ComponentSpec>& specs() {
    static const auto all = stack::simulated_stack();
    return all;
  }
  void record(const topics::Description& topic, const void* sample) {
    const auto index = static_cast<std::size_t>(
        std::ranges::find(topics::kAll, topic.name, &topics::Description::name) - topics::kAll.begin());
    now_ns_ = std::max(now_ns_ + 1, stack_.now_ns());
    const auto& header = *static_cast<const msg::Header*>(sample);
    const auto tick = header.tick;
    if (topic.name == topics::supervisor.description.name) newest_ = header;
    const bool by_operator =
        topic.name == topics::request.description.name || topic.name == topics::jog.description.name;
    if (by_operator && misses_operators_) return;
    const bool by_supervisor =
        topic.name == topics::command.description.name || topic.name == topics::supervisor.description.name;
    if (by_supervisor && misses_first_step_ && known_.insert(topic.name).second) return;
    writer_.message(channels_[index], static_cast<std::uint32_t>(tick), now_ns_, now_ns_,
                    replay::encoded(topic, sample));
  }

  configuration::Rig rig_;
  const control::Controller& controller_;
  recording::McapWriter writer_;
  recording::TopicChannels channels_;
  std::int64_t now_ns_ = 0;
  campaign::VirtualStack stack_;
  bus::Bus bus_;
  stack::OperatorClient operator_;
  bus::Publisher<msg::Jog> jogs_;
  msg::Header newest_{};  ///< of crane/supervisor
  std::uint64_t last_id_ = 0;
  bool misses_operators_ = false, misses_first_step_ = false, loses_statuses_ = false;
  std::set<std::string_view> known_;  ///< topics of the supervisor with a sample
};

struct LateRun {
  const char *rig, *controller;
  std::uint32_t seed;
};

class LateProcesses : public testing::TestWithParam<LateRun> {
 protected:
  void SetUp() override { spdlog::set_level(spdlog::level::off); }
  void TearDown() override { spdlog::set_level(spdlog::level::info); }

  /// Every process is paused at random times, most often for a part of a period; the crane moves and stops.
  void operate(LateStack& crane) {
    constexpr std::array kSources{crane_SOURCE_PLANT,      crane_SOURCE_PLANNER,  crane_SOURCE_TRACKING,
                                  crane_SOURCE_ANTI_SWING, crane_SOURCE_FRICTION, crane_SOURCE_SUPERVISOR};
    std::mt19937 random{GetParam().seed};
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>{low, high}(random);
    };
    crane.run(0.5);
    for (int second = 0; second < 60; ++second) {
      if (second % 6 == 1) crane.ask({.kind = crane_REQUEST_RESET});
      if (second % 6 == 3) crane.ask({.kind = crane_REQUEST_ARM});
      if (second % 6 >= 4)
        crane.ask({.kind = crane_REQUEST_MOVE,
                   .selected = {true, true, false},
                   .target = {uniform(0.4, 0.9), uniform(-0.5, 0.5), 0}});
      for (int i = 0; i < 20; ++i) {
        if (uniform(0, 1) < 0.1)
          crane.suspend(kSources.at(random() % kSources.size()),
                        uniform(0, 1) < 0.8 ? uniform(0, 0.02) : 0.045);
        crane.run(uniform(0.03, 0.07));
      }
    }
  }
  recording::TemporaryDirectory directory_;
};

TEST_P(LateProcesses, AreReplayedBitForBit) {
  SCOPED_TRACE("seed " + std::to_string(GetParam().seed));
  const auto file = directory_ / "late.mcap";
  LateStack crane{file, GetParam().rig, GetParam().controller};
  operate(crane);
  crane.close();
  const auto result = replay::replay(file, replay::loop_components());
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.ends, "");
  EXPECT_GT(result.equal_ticks, 5500U) << "60 s at 0.03 to 0.07 s for each of 20 intervals of a second";
  EXPECT_GT(result.irregular_ticks, 50U);
  EXPECT_GT(result.skipped_ticks, 0U);
  EXPECT_GT(result.steps_without_state, 0U);
  EXPECT_EQ(result.not_recorded, 0U);
}

/// A session of 100 samples of the stick, of which the recorder misses the first ones, then the release.
replay::Result with_lost_jogs(int lost, bool release_is_lost) {
  const recording::TemporaryDirectory directory;
  const auto file = directory / "jog.mcap";
  LateStack crane{file, "virginia_tech_tower", "gain_scheduling_partial"};
  crane.miss_operators(true);
  crane.run(1.3);
  crane.ask({.kind = crane_REQUEST_RESET});
  crane.run(1.1);
  crane.ask({.kind = crane_REQUEST_ARM});
  crane.run(1);
  crane.ask({.kind = crane_REQUEST_JOG, .selected = {false, true, false}});
  crane.run(0.02);
  for (int i = 0; i < 100; ++i) {
    crane.miss_operators(i < lost);
    crane.deflect(i < 20 ? 0.2 : 0.3);
  }
  crane.miss_operators(release_is_lost);
  crane.deflect(0, false);
  crane.run(2);
  crane.close();
  return replay::replay(file, replay::loop_components());
}

void expect_whole(const replay::Result& result) {
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.ends, "");
  EXPECT_GT(result.equal_ticks, 600U);
}

TEST(LostJogs, AtTheBeginningFollowFromTheAcceptedSamples) { expect_whole(with_lost_jogs(30, false)); }

TEST(LostJogs, OfAWholeSessionFollowFromTheAcceptedSamples) { expect_whole(with_lost_jogs(100, true)); }

/// A reader of another vendor may not receive the first sample of a writer. The next state shows that the
/// command was applied.
TEST(LostFirstStep, OfTheSupervisorFollowsFromTheAppliedCommand) {
  const recording::TemporaryDirectory directory;
  const auto file = directory / "first_step.mcap";
  LateStack crane{file, "virginia_tech_tower", "gain_scheduling_partial"};
  crane.miss_first_step();
  crane.suspend(crane_SOURCE_SUPERVISOR, 0.075);
  crane.run(1.5);
  crane.close();
  const auto result = replay::replay(file, replay::loop_components());
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.ends, "");
  EXPECT_GT(result.equal_ticks, 130U);
  EXPECT_EQ(result.not_recorded, 2U) << "a command and a status";
}

/// The status of an accepted move was published in time, and the planner did not receive it.
replay::Result with_lost_statuses(int moves) {
  const recording::TemporaryDirectory directory;
  const auto file = directory / "lost_statuses.mcap";
  LateStack crane{file, "virginia_tech_tower", "gain_scheduling_partial"};
  crane.run(1.3);
  crane.ask({.kind = crane_REQUEST_RESET});
  crane.run(1.1);
  crane.ask({.kind = crane_REQUEST_ARM});
  crane.run(1);
  for (int i = 0; i < moves; ++i) {
    crane.ask(
        {.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {0.4 + 0.05 * i, 0, 0}});
    crane.run_a_tick_without_status();
    crane.run(0.5);
  }
  crane.close();
  return replay::replay(file, replay::loop_components());
}

TEST(LostStatuses, AreDecidedByTheReference) {
  const auto result = with_lost_statuses(4);
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.ends, "");
  EXPECT_EQ(result.decided_by_outputs, 4U);
}

TEST(LostStatuses, EndTheReplayWhenTooManyTicksAreUndecided) {
  const auto result = with_lost_statuses(9);
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_NE(result.ends.find("crane/reference differs, and in tick"), std::string::npos) << result.ends;
  EXPECT_NE(result.ends.find("the planner may have lacked crane/supervisor"), std::string::npos)
      << result.ends;
  EXPECT_EQ(result.decided_by_outputs, 7U);
}

INSTANTIATE_TEST_SUITE_P(Replay, LateProcesses,
                         testing::Values(LateRun{"virginia_tech_tower", "gain_scheduling_partial", 1},
                                         LateRun{"virginia_tech_tower", "delayed_2", 2},
                                         LateRun{"virginia_tech_tower", "anti_swing_pd", 3}),
                         [](const auto& each) { return std::string{each.param.controller}; });

}  // namespace
}  // namespace crane::replay_test
