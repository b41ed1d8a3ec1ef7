#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "closed_loop.hpp"
#include "crane/simulator/simulated_board.hpp"
#include "every_effect.hpp"
#include "structure_motion.hpp"

namespace crane::simulator {
namespace {

using plant::TermSetting;
using test::every_effect;

constexpr std::int64_t kStep_ns = 10'000'000;

struct Record {
  std::vector<std::array<std::int32_t, bridge::kCounters>> counts;
  std::vector<plant::State> truth;
  friend bool operator==(const Record&, const Record&) = default;
};

/// 5 s of motion of trolley and slew in both directions. `twice`: writes and reads twice per tick.
Record driven_for_5_s(const std::vector<TermSetting>& terms, bool twice = false) {
  SimulatedRig rig;
  rig.terms = terms;
  SimulatedBoard board{rig};
  bridge::Outputs outputs;
  outputs.brake_release = {true, true, true};
  Record record;
  for (int tick = 0; tick < 500; ++tick) {
    board.advance_to(tick * kStep_ns);
    if (twice) (void)board.read();
    record.counts.push_back(board.read().raw_counts);
    record.truth.push_back(board.truth());
    const double t = 0.01 * tick;
    outputs.drive_v = {1.5 * std::cos(2.1 * t), 2 * std::cos(1.7 * t), 0.5 * std::sin(t)};
    outputs.watchdog_level = !outputs.watchdog_level;
    if (twice) {
      bridge::Outputs other = outputs;
      other.drive_v = {7, 7, 7};
      board.write(other);
    }
    board.write(outputs);
  }
  return record;
}

bool all_finite(const Record& record) {
  for (const plant::State& state : record.truth)
    for (const double value : plant::to_array(state))
      if (!std::isfinite(value)) return false;
  return true;
}

TEST(SimulatedTerms, AreSeenByTheEncodersOneByOne) {
  const Record plain = driven_for_5_s({});
  ASSERT_GT(std::abs(plain.truth[100].slew_rad), 0.1);  // it moves
  std::set<std::string> seen;
  for (const TermSetting& term : every_effect()) {
    SCOPED_TRACE(term.name + " " + term.axis);
    const Record record = driven_for_5_s({term});
    EXPECT_TRUE(all_finite(record));
    EXPECT_NE(record.counts, plain.counts);
    seen.insert(term.name);
  }
  EXPECT_EQ(seen.size(), plant::term_kinds().size());
}

TEST(SimulatedTerms, WithTheirDefaultsGiveTheSameBitsAsWithout) {
  const Record plain = driven_for_5_s({});
  std::vector<TermSetting> defaults;
  for (const plant::TermKind& kind : plant::term_kinds())
    for (const std::string_view axis : kind.axes)
      defaults.push_back({std::string{kind.name}, std::string{axis}, {}});
  EXPECT_EQ(driven_for_5_s(defaults), plain);
}

TEST(SimulatedTerms, RunAllTogetherAndTwiceTheSame) {
  const Record record = driven_for_5_s(every_effect());
  EXPECT_TRUE(all_finite(record));
  EXPECT_EQ(driven_for_5_s(every_effect()), record);
}

TEST(SimulatedTerms, ActOnceATickHoweverOftenTheBoardIsWrittenAndRead) {
  EXPECT_EQ(driven_for_5_s(every_effect(), true), driven_for_5_s(every_effect()));
}

TEST(SimulatedTerms, OfTheCommandContinueWithoutWrites) {
  SimulatedRig rig;
  rig.terms = {{"command_delay", "trolley", {{"delay_s", 0.02}}}};
  rig.watchdog_timeout_s = 1;
  SimulatedBoard board{rig};
  bridge::Outputs outputs;
  outputs.brake_release = {true, true, true};
  for (int tick = 0; tick < 20; ++tick) {
    outputs.watchdog_level = !outputs.watchdog_level;
    board.write(outputs);
    board.advance_to((tick + 1) * kStep_ns);
  }
  outputs.drive_v = {1, 0, 0};
  board.write(outputs);
  board.advance_to(22 * kStep_ns);
  EXPECT_EQ(board.truth().trolley_mps, 0);
  board.advance_to(30 * kStep_ns);
  EXPECT_GT(board.truth().trolley_mps, 0.1);
}

std::vector<TermSetting> structures() {
  return {{"jib_flexibility", "", {{"compliance_s2", 0.003}}},
          {"cable_elasticity", "", {{"compliance_mpn", 0.002}}},
          {"double_pendulum", "", {{"lower_share", 0.4}, {"lower_length_m", 0.25}}},
          {"backlash", "slew", {{"gap", 0.01}}}};
}

/// The tolerance is that of the other comparisons of the integrator with the maneuvers of closed_loop.hpp.
TEST(SimulatedTerms, OfTheStructureMoveAsWithRungeKuttaOf100Microseconds) {
  const plant::Model model{{}, structures()};
  Integrator integrator{model};
  test::StructureMotion fine{{.trolley_m = 0.5, .radial_rad = 0.1}};
  plant::State state = fine.state;
  plant::InnerState inner{};
  for (int tick = 0; tick < 200; ++tick) {
    const plant::Actuation actuation =
        test::driven({2 * std::cos(0.03 * tick), 2 * std::sin(0.05 * tick), 0.3});
    integrator.advance(state, inner, actuation, test::kTick_s);
    for (int i = 0; i < 100; ++i) fine = test::step(model, fine, actuation, 1e-4);
  }
  const auto a = plant::to_array(state), b = plant::to_array(fine.state);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 2e-5) << i;
  for (std::size_t i = 0; i < model.inner_coordinates(); ++i) {
    EXPECT_NEAR(inner[i].position, fine.inner[i].position, 2e-5) << i;
    EXPECT_GT(std::abs(inner[i].position), 1e-4) << i;
  }
}

TEST(SimulatedTerms, OfTheStructureSwingOnWhileBrakesHoldTheDrivesExactly) {
  SimulatedRig rig;
  rig.terms = structures();
  SimulatedBoard board{rig};
  bridge::Outputs outputs;
  const auto run = [&](bool release, double volts, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      outputs.brake_release = {release, release, release};
      outputs.drive_v = {volts, volts, 0};
      outputs.watchdog_level = !outputs.watchdog_level;
      board.write(outputs);
      board.advance_to(board.now_ns() + kStep_ns);
    }
  };
  run(true, 2, 60);
  EXPECT_GT(board.truth().slew_radps, 0.2);
  run(false, 0, 100);
  const plant::State held = board.truth();
  EXPECT_EQ(held.slew_radps, 0);
  EXPECT_EQ(held.trolley_mps, 0);
  run(false, 2, 10);
  EXPECT_EQ(board.truth().slew_rad, held.slew_rad);
  EXPECT_NE(board.truth().tangential_rad, held.tangential_rad);
}

}  // namespace
}  // namespace crane::simulator
