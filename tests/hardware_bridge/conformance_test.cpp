// Requirements of the interface Board, tested for every board.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "crane/bridge/bridge.hpp"
#include "crane/bridge/component.hpp"
#include "crane/bridge/measurement.hpp"
#include "crane/runtime/in_process.hpp"
#include "subject.hpp"

namespace crane::bridge::test {
namespace {

constexpr double kStep_v = 20.0 / 8192;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Conformance : public testing::TestWithParam<Kind> {
 protected:
  void put_on_bench(const configuration::Rig& rig) {
    subject_.reset();  // some boards can be opened only once
    subject_ = GetParam().make(rig);
  }
  void SetUp() override { put_on_bench(rig_); }
  /// Trolley and jib in motion, brakes open.
  void get_going() {
    subject_->open_brakes();
    subject_->tick({4, 4, 0}, true, 20);
    ASSERT_FALSE(subject_->braked());
    ASSERT_GT(subject_->crane().truth().trolley_mps, 0.5);
    ASSERT_GT(subject_->crane().truth().slew_radps, 0.3);
  }
  void expect_safe() {
    EXPECT_EQ(subject_->amplifier_v(), kNothing);
    subject_->pass(20'000'000 + 1);  // a brake takes 20 ms to close
    EXPECT_TRUE(subject_->braked());
  }
  configuration::Rig rig_ = emulated_rig();
  std::unique_ptr<Subject> subject_;
};

TEST_P(Conformance, OpensWithZeroVoltsAndClosedBrakes) {
  EXPECT_EQ(subject_->amplifier_v(), kNothing);
  subject_->pass(kTick_ns);
  EXPECT_TRUE(subject_->braked());
  const auto inputs = subject_->board().read();
  EXPECT_TRUE(inputs.watchdog_dropped);
  EXPECT_EQ(inputs.brake_closed, (std::array<bool, kDrives>{true, true, true}));
  EXPECT_EQ(subject_->crane().truth().trolley_m, rig_.start.position[0]);
}

TEST_P(Conformance, PowersUpAtZeroVoltsNotAtTheVoltageOfCodeZero) {
  EXPECT_EQ(subject_->amplifier_v(), kNothing);
  subject_->board().make_safe();
  EXPECT_EQ(subject_->amplifier_v(), kNothing);
}

TEST_P(Conformance, IsSafeAfterMakeSafe) {
  get_going();
  subject_->board().make_safe();
  expect_safe();
}

TEST_P(Conformance, IsSafeAfterItsProgramHasEnded) {
  get_going();
  subject_->close();
  expect_safe();
}

/// Passes a board to a bridge. The crane must outlive board and bridge.
class Lent final : public Board {
 public:
  explicit Lent(Board& board) : board_{board} {}
  std::string_view name() const override { return board_.name(); }
  Inputs read() override {
    if (++reads_ == 2) throw std::runtime_error("the board has burnt");
    return board_.read();
  }
  std::array<double, kDrives> write(const Outputs& outputs) override { return board_.write(outputs); }
  void make_safe() noexcept override { board_.make_safe(); }
  void advance_to(std::int64_t /*time_ns*/) override {}

 private:
  Board& board_;
  int reads_ = 0;
};

TEST_P(Conformance, IsSafeAfterAnExceptionInTheBridge) {
  bus::Bus bus{runtime::memory_options(bus::make_memory_network(), "bridge", crane_SOURCE_BRIDGE)};
  runtime::Node node{bus, {"bridge", ""}};
  const runtime::ComponentSpec spec = hardware_bridge_spec();
  const auto& none = *control::find_controller("none");
  runtime::Ports ports{bus, spec, none, rig_.design, runtime::Clock::realtime};
  const runtime::Context context{ports, node, rig_, none, bus.options(), runtime::Clock::realtime};
  const auto run_into_it = [&] {
    Bridge bridge{context, std::make_unique<Lent>(subject_->board())};
    get_going();
    for (std::int64_t now_ns = 0;; now_ns += kTick_ns) bridge.poll(now_ns);
  };
  EXPECT_THROW(run_into_it(), std::runtime_error);
  expect_safe();
}

TEST_P(Conformance, LosesItsBrakeSupplyWhenTheWatchdogOutputStopsToggling) {
  get_going();
  subject_->pass(std::llround(rig_.wiring.relay_timeout_s * 1e9));
  EXPECT_TRUE(subject_->board().read().watchdog_dropped);
  subject_->pass(20'000'000);
  EXPECT_TRUE(subject_->braked());
  EXPECT_NE(subject_->amplifier_v(), kNothing)
      << "the converters hold their last value; the brakes hold the crane";
}

TEST_P(Conformance, KeepsTheBrakesClosedWithoutToggling) {
  for (int i = 0; i < 20; ++i) {
    subject_->board().write({{5, 5, 5}, {true, true, true}, true});
    subject_->pass(kTick_ns);
  }
  EXPECT_TRUE(subject_->braked());
  EXPECT_EQ(subject_->crane().truth().trolley_m, rig_.start.position[0]);
}

TEST_P(Conformance, NeverOutputsAVoltageThatIsNotFinite) {
  get_going();
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(subject_->tick({bad, bad, bad}, true), kNothing) << bad;
    EXPECT_EQ(subject_->amplifier_v(), kNothing) << bad;
  }
}

TEST_P(Conformance, ClampsInsteadOfWrapping) {
  for (const double v : {10.0, 10.01, 11.0, 1e3, 1e300}) {
    subject_->tick({v, v, v}, false);
    EXPECT_EQ(subject_->amplifier_v(), (std::array<double, kDrives>{10, 10, 10})) << v;
  }
  for (const double v : {-10.0, -10.01, -11.0, -1e3, -1e300}) {  // -10 V must not become +10 V
    subject_->tick({v, v, v}, false);
    for (const double given : subject_->amplifier_v()) EXPECT_DOUBLE_EQ(given, -10 + kStep_v) << v;
  }
}

TEST_P(Conformance, OutputsTheVoltageOfEachDriveWithinHalfAStepAndReportsIt) {
  for (double v = -9.9; v < 9.9; v += 0.37) {
    const std::array<double, kDrives> wanted{v, -v, v / 3};
    const auto given = subject_->tick(wanted, false);
    EXPECT_EQ(given, subject_->amplifier_v());
    for (std::size_t i = 0; i < kDrives; ++i) EXPECT_LE(std::abs(given[i] - wanted[i]), kStep_v / 2 + 1e-12);
  }
}

TEST_P(Conformance, CountsFromTheStartOfTheRigFile) {
  const auto inputs = subject_->board().read();
  for (std::size_t i = 0; i < kDrives; ++i)
    EXPECT_EQ(inputs.raw_counts[i], std::llround(rig_.encoders[i].sign * rig_.start.position[i] *
                                                 rig_.encoders[i].counts_per_unit));
}

TEST_P(Conformance, CountsTheRestAngleOfASwingEncoderWhileTheLoadIsAtRest) {
  rig_.encoders[3].rest_angle_rad = 0.02;
  rig_.encoders[4].rest_angle_rad = -0.03;
  put_on_bench(rig_);
  const auto inputs = subject_->board().read();
  for (std::size_t i = kDrives; i < kCounters; ++i)
    EXPECT_EQ(inputs.raw_counts[i], std::llround(rig_.encoders[i].sign * rig_.encoders[i].rest_angle_rad *
                                                 rig_.encoders[i].counts_per_unit));
}

TEST_P(Conformance, CountsInTheDirectionOfItsSign) {
  for (const int sign : {1, -1}) {
    rig_.encoders[0].sign = rig_.encoders[4].sign = sign;
    rig_.drives[1].sign = -sign;
    put_on_bench(rig_);
    subject_->open_brakes();
    const auto before = subject_->board().read().raw_counts;
    subject_->crane().kick(0, 0.2);
    subject_->tick({3, 3, 0}, true, 20);
    const auto after = subject_->board().read().raw_counts;
    EXPECT_GT(sign * (after[0] - before[0]), 1000);   // trolley: a positive voltage moves it outwards
    EXPECT_GT(-sign * (after[1] - before[1]), 1000);  // slew: its drive is wired with the opposite sign
    EXPECT_GT(sign * (after[4] - before[4]), 10);     // tangential swing
  }
}

/// Drives the trolley across the wrap of the counter, forwards and back.
TEST_P(Conformance, CountsThroughTheWrapOf24BitsInBothDirections) {
  rig_.encoders[0].counts_per_unit = 0x7FFFFF / (rig_.start.position[0] + 0.02);
  put_on_bench(rig_);
  CountUnwrapper unwrapper;
  std::ignore = unwrapper.step(subject_->board().read().raw_counts[0]);
  subject_->open_brakes();
  int wraps = 0;
  std::int32_t last = 0;
  for (int i = 0; i < 150; ++i) {
    subject_->tick({i < 40 ? 4.0 : -8.0, 0, 0}, true);
    const auto raw = subject_->board().read().raw_counts[0];
    if (i > 0 && std::abs(raw - last) > 0x800000) ++wraps;
    last = raw;
    EXPECT_EQ(unwrapper.step(raw),
              std::llround(subject_->crane().truth().trolley_m * rig_.encoders[0].counts_per_unit));
  }
  EXPECT_EQ(wraps, 2);
}

/// The counts at the start exceed the range of a 24-bit counter.
TEST_P(Conformance, BeginsAtTheStartOfTheRigFileBeyond24Bits) {
  for (const int sign : {1, -1}) {
    rig_.encoders[0].counts_per_unit = 3e8;
    rig_.encoders[0].sign = sign;
    put_on_bench(rig_);
    MeasurementPipeline pipeline{rig_};
    const auto measured = pipeline.step(subject_->board().read().raw_counts);
    EXPECT_NEAR(measured.position[0], rig_.start.position[0], 1e-8);
    EXPECT_NEAR(measured.position[0], subject_->crane().truth().trolley_m, 1e-8);
  }
}

TEST_P(Conformance, ReadsTheSameTwiceWhileNothingMoves) {
  get_going();
  EXPECT_EQ(subject_->board().read().raw_counts, subject_->board().read().raw_counts);
}

TEST_P(Conformance, SeesSwitchesBrakesAndTheEmergencyStop) {
  rig_.start.position[0] = rig_.drives[0].low_limit;
  put_on_bench(rig_);
  EXPECT_EQ(subject_->board().read().limit_low, (std::array<bool, kDrives>{true, false, false}));
  EXPECT_EQ(subject_->board().read().limit_high, (std::array<bool, kDrives>{}));
  subject_->open_brakes();
  EXPECT_EQ(subject_->board().read().brake_closed, (std::array<bool, kDrives>{}));
  EXPECT_FALSE(subject_->board().read().watchdog_dropped);
  EXPECT_FALSE(subject_->board().read().estop_pressed);
  subject_->crane().press_estop(true);
  EXPECT_TRUE(subject_->board().read().estop_pressed);
  subject_->tick({}, true, 3);
  EXPECT_TRUE(subject_->braked()) << "the emergency stop cuts the supply by itself";
}

TEST_P(Conformance, ShowsAMarkBelowItsPositionAndCountsAnUnhomedAxisFromTheFarEnd) {
  auto rig = configuration::load_rig(CRANE_RIGS "/homing_servo_to_go.toml");
  for (const double slew_rad : {0.05, 0.15}) {
    rig.start.position[1] = slew_rad;
    put_on_bench(rig);
    const auto inputs = subject_->board().read();
    EXPECT_EQ(inputs.mark, (std::array<bool, kDrives>{false, slew_rad < 0.1, false})) << slew_rad;
    for (std::size_t i = 0; i < kDrives; ++i)
      EXPECT_NEAR(inputs.raw_counts[i] * rig.encoders[i].sign / rig.encoders[i].counts_per_unit,
                  rig.drives[i].high_limit, 1e-4)
          << "nothing may tell where axis " << i << " stands";
  }
}

TEST(ConformanceSuite, CoversTheDriverOfEveryBoardOfARigFile) {
  std::vector<std::string> covered;
  for (const auto& kind : all_boards()) covered.insert(covered.end(), kind.covers.begin(), kind.covers.end());
  for (const auto& board : board_kinds()) EXPECT_THAT(covered, testing::Contains(board.name));
}

INSTANTIATE_TEST_SUITE_P(Boards, Conformance, testing::ValuesIn(all_boards()),
                         [](const auto& test) { return std::string{test.param.name}; });

}  // namespace
}  // namespace crane::bridge::test
