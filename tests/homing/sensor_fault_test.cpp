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
configuration::Rig unchecked(const std::string& name) {
  configuration::Rig rig = configuration::load_rig(CRANE_RIGS "/" + name + ".toml");
  rig.limits.model_checks = false;
  return rig;
}
configuration::Rig tower() { return unchecked("virginia_tech_tower"); }

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

/// Wiring fault of the encoders of two axes: the counter of axis axes[i] counts the motion of axis
/// axes[source[i]] times sign[i].
struct WrongWires {
  const char* name;
  const char* rig;
  std::size_t moved;  ///< axis of the move
  std::array<std::size_t, 2> axes;
  std::array<std::size_t, 2> source;
  std::array<int, 2> sign;

  [[nodiscard]] Spoil spoil() const {
    return [*this, first = std::optional<std::array<std::int32_t, 2>>{}](bridge::Inputs& inputs,
                                                                         const plant::State&) mutable {
      const std::array<std::int32_t, 2> raw{inputs.raw_counts[axes[0]], inputs.raw_counts[axes[1]]};
      if (!first) first = raw;
      for (std::size_t i = 0; i < 2; ++i)
        inputs.raw_counts[axes[i]] = (*first)[i] + sign[i] * (raw[source[i]] - (*first)[source[i]]);
    };
  }
};
std::ostream& operator<<(std::ostream& out, const WrongWires& wires) { return out << wires.name; }

class EncoderWiredWrong : public testing::TestWithParam<WrongWires> {};

TEST_P(EncoderWiredWrong, StopsTheFirstMoveInsideTheHardLimits) {
  const auto& wires = GetParam();
  auto rig = unchecked(wires.rig);
  rig.limits.model_checks = true;
  LockstepCrane crane{"simulated", rig, rig};
  crane.spoil = wires.spoil();
  crane.arm();
  const std::array<double, 2> start{crane.truth(wires.axes[0]), crane.truth(wires.axes[1])};
  stack::OperatorRequest move{.kind = crane_REQUEST_MOVE};
  move.selected[wires.moved] = true;
  move.target[wires.moved] = crane.shown(wires.moved) + 0.5;
  ASSERT_EQ(crane.ask(move), "");
  double farthest = 0;
  bool inside = true;
  crane.every_tick = [&] {
    for (std::size_t i = 0; i < 2; ++i) {
      const double truth = crane.truth(wires.axes[i]);
      const auto& drive = rig.drives[wires.axes[i]];
      farthest = std::max(farthest, std::abs(truth - start[i]));
      inside = inside && truth >= drive.low_limit && truth <= drive.high_limit;
    }
  };
  crane.run_until([&crane] { return crane.status().state == crane_STATE_LOCKED; }, 10);
  EXPECT_EQ(crane.cause(), supervisor::Cause::following_error) << supervisor::name_of(crane.cause());
  EXPECT_TRUE(crane.safe());
  EXPECT_TRUE(inside) << "moved by " << farthest;
  std::cout << wires.name << ": stopped after " << farthest << '\n';
}

class EncoderWiredWrongWithoutModel : public testing::TestWithParam<WrongWires> {};

/// Without model checks the limit switch is the last protection: it operates at the true position. The axis
/// stops within the stopping distance at full speed, which is the soft margin.
TEST_P(EncoderWiredWrongWithoutModel, StopsAtTheLimitSwitchAtTheLatest) {
  const auto& wires = GetParam();
  std::array<double, 2> worst{}, worst_beyond{};
  int runs = 0;
  for (const double distance : {0.1, 0.5, -0.1, -0.3})
    for (const auto& controller : control::controllers()) {
      auto rig = unchecked(wires.rig);
      if (!control::problems(controller, rig.design).empty()) continue;  // the law does not fit this rig
      rig.controller = controller.name;
      LockstepCrane crane{"simulated", rig, rig};
      crane.spoil = wires.spoil();
      crane.arm();
      const std::array<double, 2> start{crane.truth(wires.axes[0]), crane.truth(wires.axes[1])};
      stack::OperatorRequest move{.kind = crane_REQUEST_MOVE};
      move.selected[wires.moved] = true;
      move.target[wires.moved] = crane.shown(wires.moved) + distance;
      if (!crane.ask(move).empty()) continue;  // beyond the soft limits
      std::array<double, 2> beyond{};
      crane.every_tick = [&] {
        for (std::size_t i = 0; i < 2; ++i) {
          const double truth = crane.truth(wires.axes[i]);
          const auto& drive = rig.drives[wires.axes[i]];
          worst[i] = std::max(worst[i], std::abs(truth - start[i]));
          beyond[i] = std::max({beyond[i], drive.low_limit - truth, truth - drive.high_limit});
        }
      };
      crane.run_until([&crane] { return crane.status().state == crane_STATE_LOCKED; }, 10);
      ++runs;
      for (std::size_t i = 0; i < 2; ++i) {
        worst_beyond[i] = std::max(worst_beyond[i], beyond[i]);
        EXPECT_LT(beyond[i], rig.drives[wires.axes[i]].soft_margin)
            << controller.name << ", " << distance << ", " << plant::kCoordinates[wires.axes[i]].name;
      }
      const bool stopped = crane.status().state == crane_STATE_LOCKED;
      EXPECT_TRUE(stopped ? crane.safe() : beyond[0] <= 0 && beyond[1] <= 0) << controller.name;
    }
  EXPECT_GT(runs, 0);
  std::cout << wires.name << ": " << runs << " runs";
  for (std::size_t i = 0; i < 2; ++i)
    std::cout << "; " << plant::kCoordinates[wires.axes[i]].name << " farthest " << worst[i]
              << ", beyond the limit " << worst_beyond[i];
  std::cout << " (m or rad)\n";
}

constexpr std::array<std::size_t, 2> kTowerAxes{plant::kTrolley, plant::kSlew},
    kGantryAxes{plant::kTrolley, plant::kHoist}, kExchanged{1, 0}, kInOrder{0, 1};
constexpr const char *kTower = "virginia_tech_tower", *kGantry = "gantry";
const auto kWrongWires = testing::Values(
    WrongWires{"exchanged_trolley", kTower, plant::kTrolley, kTowerAxes, kExchanged, {1, 1}},
    WrongWires{"exchanged_slew", kTower, plant::kSlew, kTowerAxes, kExchanged, {1, 1}},
    WrongWires{"sign_trolley", kTower, plant::kTrolley, kTowerAxes, kInOrder, {-1, 1}},
    WrongWires{"sign_slew", kTower, plant::kSlew, kTowerAxes, kInOrder, {1, -1}},
    WrongWires{"gantry_exchanged_trolley", kGantry, plant::kTrolley, kGantryAxes, kExchanged, {1, 1}},
    WrongWires{"gantry_exchanged_hoist", kGantry, plant::kHoist, kGantryAxes, kExchanged, {1, 1}},
    WrongWires{"gantry_sign_trolley", kGantry, plant::kTrolley, kGantryAxes, kInOrder, {-1, 1}},
    WrongWires{"gantry_sign_hoist", kGantry, plant::kHoist, kGantryAxes, kInOrder, {1, -1}});
std::string name_of(const testing::TestParamInfo<WrongWires>& test) { return test.param.name; }

INSTANTIATE_TEST_SUITE_P(InAMove, EncoderWiredWrongWithoutModel, kWrongWires, name_of);
INSTANTIATE_TEST_SUITE_P(InAMove, EncoderWiredWrong, kWrongWires, name_of);

}  // namespace
}  // namespace crane::homing_test
