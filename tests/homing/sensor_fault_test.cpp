// An encoder fails during a move, in closed loop: the axis stops far from the end of its travel.
#include "lockstep_crane.hpp"

#include "crane/plant/coordinates.hpp"

namespace crane::homing_test {
namespace {

struct FrozenMove {
  std::size_t axis;
  double distance;  ///< m or rad
};
std::ostream& operator<<(std::ostream& out, const FrozenMove& move) {
  return out << plant::kCoordinates[move.axis].name << " by " << move.distance;
}

/// Without the model checks of the supervisor, which are often faster: the bridge must detect a dead encoder
/// alone.
configuration::Rig tower() {
  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
  rig.limits.model_checks = false;
  return rig;
}

class EncoderDies : public testing::TestWithParam<FrozenMove> {};

TEST_P(EncoderDies, AsAMoveBeginsAndTheAxisStopsInsideItsLimits) {
  const auto [axis, distance] = GetParam();
  LockstepCrane crane{"simulated", tower(), tower()};
  crane.arm();
  ASSERT_EQ(crane.status().state, crane_STATE_HOLD);
  const double start = crane.truth(axis);
  std::optional<std::int32_t> frozen;
  crane.spoil = [&frozen, axis = axis](bridge::Inputs& inputs, const plant::State& /*truth*/) {
    if (!frozen) frozen = inputs.raw_counts[axis];
    inputs.raw_counts[axis] = *frozen;
  };
  stack::OperatorRequest move{.kind = crane_REQUEST_MOVE};
  move.selected[axis] = true;
  move.target[axis] = start + distance;
  ASSERT_EQ(crane.ask(move), "");
  double farthest = 0;
  crane.every_tick = [&] { farthest = std::max(farthest, std::abs(crane.truth(axis) - start)); };
  crane.run_until([&crane] { return crane.state().latch_reason != crane_LATCH_NONE; }, 3);
  EXPECT_EQ(crane.state().latch_reason, crane_LATCH_ENCODER_FROZEN);
  crane.run(0.5);
  EXPECT_TRUE(crane.safe());
  std::cout << GetParam() << ": stopped after " << farthest << '\n';
  EXPECT_LT(farthest, 0.1) << "m or rad";
}

INSTANTIATE_TEST_SUITE_P(InAMove, EncoderDies,
                         testing::Values(FrozenMove{plant::kTrolley, 0.75}, FrozenMove{plant::kTrolley, 0.5},
                                         FrozenMove{plant::kTrolley, 1.0}, FrozenMove{plant::kSlew, 1.57}),
                         [](const auto& test) {
                           return std::string{plant::kCoordinates[test.param.axis].name} + "_" +
                                  std::to_string(std::lround(100 * test.param.distance));
                         });

struct WrongWires {
  const char* name;
  std::size_t axis;  ///< axis of the move
  Spoil spoil;
};
std::ostream& operator<<(std::ostream& out, const WrongWires& wires) { return out << wires.name; }

class EncoderWiredWrong : public testing::TestWithParam<WrongWires> {};

TEST_P(EncoderWiredWrong, StopsTheFirstMoveInsideTheHardLimits) {
  const auto [name, axis, spoil] = GetParam();
  auto rig = tower();
  rig.limits.model_checks = true;
  LockstepCrane crane{"simulated", rig, rig};
  crane.spoil = spoil;
  crane.arm();
  const std::array<double, 2> start{crane.truth(0), crane.truth(1)};
  stack::OperatorRequest move{.kind = crane_REQUEST_MOVE};
  move.selected[axis] = true;
  move.target[axis] = crane.shown(axis) + 0.5;
  ASSERT_EQ(crane.ask(move), "");
  double farthest = 0;
  bool inside = true;
  crane.every_tick = [&] {
    for (std::size_t i = 0; i < 2; ++i) {
      const double truth = crane.truth(i);
      farthest = std::max(farthest, std::abs(truth - start[i]));
      inside = inside && truth >= rig.drives[i].low_limit && truth <= rig.drives[i].high_limit;
    }
  };
  crane.run_until([&crane] { return crane.status().state == crane_STATE_LOCKED; }, 10);
  EXPECT_EQ(crane.cause(), supervisor::Cause::following_error) << supervisor::name_of(crane.cause());
  EXPECT_TRUE(crane.safe());
  EXPECT_TRUE(inside) << "moved by " << farthest;
  std::cout << name << ": stopped after " << farthest << '\n';
}

/// Wiring fault of the encoders of trolley and slew axis: counter i counts the motion of encoder source[i]
/// times sign[i].
Spoil rewired(std::array<std::size_t, 2> source, std::array<int, 2> sign) {
  return [=, first = std::optional<std::array<std::int32_t, 2>>{}](bridge::Inputs& inputs,
                                                                   const plant::State& /*truth*/) mutable {
    const std::array<std::int32_t, 2> raw{inputs.raw_counts[0], inputs.raw_counts[1]};
    if (!first) first = raw;
    for (std::size_t i = 0; i < 2; ++i)
      inputs.raw_counts[i] = (*first)[i] + sign[i] * (raw[source[i]] - (*first)[source[i]]);
  };
}

class EncoderWiredWrongWithoutModel : public testing::TestWithParam<WrongWires> {};

/// Without model checks the limit switch is the last protection: it operates at the true position. The axis
/// stops within the stopping distance at full speed, which is the soft margin.
TEST_P(EncoderWiredWrongWithoutModel, StopsAtTheLimitSwitchAtTheLatest) {
  const auto& [name, axis, spoil] = GetParam();
  std::array<double, 2> worst{};
  for (const double distance : {0.1, 0.5, -0.1, -0.3})
    for (const auto& controller : control::controllers()) {
      auto rig = tower();
      rig.controller = controller.name;
      LockstepCrane crane{"simulated", rig, rig};
      crane.spoil = spoil;
      crane.arm();
      const std::array<double, 2> start{crane.truth(0), crane.truth(1)};
      stack::OperatorRequest move{.kind = crane_REQUEST_MOVE};
      move.selected[axis] = true;
      move.target[axis] = crane.shown(axis) + distance;
      if (!crane.ask(move).empty()) continue;  // beyond the soft limits
      std::array<double, 2> beyond{};
      crane.every_tick = [&] {
        for (std::size_t i = 0; i < 2; ++i) {
          const double truth = crane.truth(i);
          worst[i] = std::max(worst[i], std::abs(truth - start[i]));
          beyond[i] =
              std::max({beyond[i], rig.drives[i].low_limit - truth, truth - rig.drives[i].high_limit});
        }
      };
      crane.run_until([&crane] { return crane.status().state == crane_STATE_LOCKED; }, 10);
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_LT(beyond[i], rig.drives[i].soft_margin)
            << controller.name << ", " << distance << ", " << plant::kCoordinates[i].name;
      const bool stopped = crane.status().state == crane_STATE_LOCKED;
      EXPECT_TRUE(stopped ? crane.safe() : beyond[0] <= 0 && beyond[1] <= 0) << controller.name;
    }
  std::cout << name << ": farthest " << worst[0] << " m, " << worst[1] << " rad\n";
}

const auto kWrongWires =
    testing::Values(WrongWires{"exchanged_trolley", plant::kTrolley, rewired({1, 0}, {1, 1})},
                    WrongWires{"exchanged_slew", plant::kSlew, rewired({1, 0}, {1, 1})},
                    WrongWires{"sign_trolley", plant::kTrolley, rewired({0, 1}, {-1, 1})},
                    WrongWires{"sign_slew", plant::kSlew, rewired({0, 1}, {1, -1})});
std::string name_of(const testing::TestParamInfo<WrongWires>& test) { return test.param.name; }

INSTANTIATE_TEST_SUITE_P(InAMove, EncoderWiredWrongWithoutModel, kWrongWires, name_of);
INSTANTIATE_TEST_SUITE_P(InAMove, EncoderWiredWrong, kWrongWires, name_of);

}  // namespace
}  // namespace crane::homing_test
