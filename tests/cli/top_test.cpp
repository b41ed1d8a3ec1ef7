/// The table of `crane top`, from synthetic samples.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/top_model.hpp"
#include "cli/top_table.hpp"
#include "crane/fields/angle.hpp"
#include "crane/runtime/node.hpp"
#include "samples.hpp"

namespace crane::cli {
namespace {

using observation::kSecond_ns, observation::sample_of;
using testing::HasSubstr;
using testing::Not;

/// A crane at 100 Hz whose states take 0.4 ms; tick 150 is lost.
class TopTest : public testing::Test {
 protected:
  void run(std::uint64_t ticks, double swing_rad = 0) {
    for (std::uint64_t i = 0; i < ticks; ++i) {
      ++tick_;
      now_ns_ += observation::kLoopPeriod_ns;
      if (tick_ != 150) {
        msg::State state{};
        state.swing_radial_rad = swing_rad;
        model_.add(delayed(sample_of(topics::state, state, now_ns_, tick_)));
      }
      model_.add(delayed(observation::status_at(now_ns_, state_, cause_, tick_)));
      if (tick_ % 100 == 1) report();
      fresh_ = model_.poll(now_ns_, now_ns_) || fresh_;
    }
  }
  static observation::SamplePtr delayed(const observation::SamplePtr& sample) {
    auto later = std::make_shared<observation::Sample>(*sample);
    later->written_time_ns += 400'000;
    return later;
  }
  void report() {
    msg::NodeStatus status{};
    status.node = crane_SOURCE_SUPERVISOR;
    runtime::assign(status.name, "supervisor");
    runtime::assign(status.vendor, "cyclone");
    status.pid = 4711;
    status.phase = crane_PHASE_READY;
    status.ticks = tick_;
    status.lost_ticks = 1;
    status.step_max_us = 123.4;
    model_.add(sample_of(topics::node, status, now_ns_, tick_));
  }
  [[nodiscard]] std::string text(const std::optional<TerminalSize>& size = std::nullopt,
                                 bool trends = false) const {
    return top_text(model_, {.title = "crane 'test'", .size = size, .trends = trends}, now_ns_, now_ns_);
  }

  TopModel model_;
  std::int64_t now_ns_ = 1000 * kSecond_ns;
  std::uint64_t tick_ = 0;
  crane_SupervisorState state_ = crane_STATE_HOLD;
  crane_Cause cause_ = crane_CAUSE_NONE;
  bool fresh_ = false;
};

TEST_F(TopTest, IsCompleteAfterAWholeWindowAndTwoReports) {
  run(90);
  EXPECT_FALSE(model_.complete());
  run(220);
  EXPECT_TRUE(model_.complete());
}

TEST_F(TopTest, SaysThatTheStateIsOldWhenTheSamplesEnd) {
  run(305);
  EXPECT_THAT(text(), Not(HasSubstr("\nOLD ")));
  now_ns_ += 16 * kSecond_ns;
  EXPECT_THAT(text(), HasSubstr("\nOLD         no sample for 16 s"));
  EXPECT_NEAR(model_.json(now_ns_)["supervisor"]["age_s"].get<double>(), 16, 1e-6);
}

TEST_F(TopTest, ShowsRatesLossesDelaysAndTicksOfProcesses) {
  run(405);
  const auto table = text();
  EXPECT_THAT(table, testing::StartsWith("crane 'test'  tick 405\nsupervisor  HOLD\n"));
  EXPECT_THAT(table,
              testing::ContainsRegex("supervisor +cyclone +4711 +ready +100\\.0 +1 +0 +0 +0\\.0 +123\\.4\n"));
  EXPECT_THAT(table, testing::ContainsRegex("crane/state +100\\.0 +1 +0 +0 +400 +400 +400\n"));
  EXPECT_THAT(table, testing::ContainsRegex("crane/twin +0 +- +- +- +- +- +-\n"));
}

TEST_F(TopTest, KeepsTheLargestSwingWithItsTick) {
  run(10, 2 * fields::kRadPerDeg);
  run(1, -7 * fields::kRadPerDeg);
  run(50, 1 * fields::kRadPerDeg);
  EXPECT_THAT(text(), HasSubstr("radial 1.00 deg (largest 7.00 at tick 11)"));
  EXPECT_NEAR(model_.json(now_ns_)["largest_swing"]["radial"]["angle_rad"].get<double>(),
              -7 * fields::kRadPerDeg, 1e-12);
}

TEST_F(TopTest, NamesCauseRemedyAndTheLastFault) {
  run(50);
  state_ = crane_STATE_STOP_C1;
  cause_ = crane_CAUSE_SWING_LIMIT;
  run(50);
  EXPECT_THAT(text(), HasSubstr("supervisor  STOP_C1 because of SWING_LIMIT: "));
  EXPECT_THAT(text(), HasSubstr("last fault   0 s ago: supervisor SWING_LIMIT: "));
  const auto json = model_.json(now_ns_);
  EXPECT_EQ(json["supervisor"]["state"], "STOP_C1");
  EXPECT_NE(json["supervisor"]["remedy"], "");
  EXPECT_EQ(json["faults"][0]["first"]["what"], "SWING_LIMIT");
}

TEST_F(TopTest, JsonHasTheFiguresOfTheTable) {
  run(405);
  const auto json = model_.json(now_ns_);
  EXPECT_EQ(json["tick"], 405);
  EXPECT_EQ(json["topics"][0]["topic"], "crane/state");
  EXPECT_EQ(json["topics"][0]["lost"], 1);
  EXPECT_NEAR(json["topics"][0]["delay_us"]["p99"].get<double>(), 400, 1e-6);
  EXPECT_NEAR(json["processes"][0]["tick_rate_hz"].get<double>(), 100, 1e-6);
}

std::size_t widest(const std::string& text) {
  std::size_t most = 0;
  std::istringstream lines{text.substr(text.find("\n\n"))};  // the sentences of the head are cut by fitted()
  for (std::string line; std::getline(lines, line);) most = std::max(most, width_of(line));
  return most;
}

TEST_F(TopTest, OmitsTheLeastImportantColumnsOnANarrowTerminal) {
  run(3200);
  for (const int columns : {140, 100, 80, 60, 40}) {
    const auto table = text(TerminalSize{columns, 60}, true);
    EXPECT_LE(widest(table), static_cast<std::size_t>(columns)) << table;
    EXPECT_THAT(table, HasSubstr("ticks/s"));
    EXPECT_THAT(table, HasSubstr("rate Hz"));
  }
  EXPECT_THAT(text(TerminalSize{140, 60}), HasSubstr("rejected"));
  EXPECT_THAT(text(TerminalSize{60, 60}), Not(HasSubstr("rejected")));
}

TEST_F(TopTest, OmitsSilentTopicsWhenTheRowsDoNotFit) {
  run(405);
  EXPECT_THAT(text(TerminalSize{140, 60}), HasSubstr("crane/twin"));
  const auto small = text(TerminalSize{140, 12});
  EXPECT_THAT(small, Not(HasSubstr("crane/twin")));
  EXPECT_THAT(small, HasSubstr("crane/state"));
}

TEST_F(TopTest, ProcessWithoutReportsIsSilent) {
  run(205);
  now_ns_ += 10 * kSecond_ns;
  EXPECT_THAT(text(), HasSubstr("silent"));
}

TEST(Sparkline, HasABlockForEachValueRelativeToTheLargest) {
  EXPECT_EQ(sparkline({0, 1, 2, 7}), "▁▂▃█");
  EXPECT_EQ(sparkline({5, 5}), "██");
  EXPECT_EQ(sparkline({0, 0}), "▁▁");
  EXPECT_EQ(sparkline({}), "");
}

}  // namespace
}  // namespace crane::cli
