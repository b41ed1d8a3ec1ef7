// Compares the port accesses of the driver with register addresses and values as literal numbers.
#include "crane/boards/servo_to_go.hpp"
#include "crane/bridge/converter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tapped_card.hpp"

namespace crane::bridge::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ConverterCode, IsInvertedOffsetBinary) {
  EXPECT_EQ(converter_code(0), 0x1000);
  EXPECT_EQ(converter_code(10), 0x0000);
  EXPECT_EQ(converter_code(5), 0x0800);
  EXPECT_EQ(converter_code(-5), 0x1800);
  EXPECT_EQ(converter_code(-10), 0x1FFF);
  EXPECT_EQ(converter_code(-10.1), 0x1FFF);
  EXPECT_EQ(converter_code(0.00244140625), 0x0FFF);
  EXPECT_DOUBLE_EQ(converter_voltage_v(0x0800), 5);
}

TEST(ConverterCode, ZeroAtStartUpWouldBeTenVolts) {
  EXPECT_DOUBLE_EQ(converter_voltage_v(0), 10);
  Plug plug;
  CardState state;
  EmulatedServoToGo card{0x200, state, plug};
  plug.codes.fill(0);  // possible state after power-on
  const auto rig = emulated_rig();
  std::vector<Access> log;
  const ServoToGo board{rig, std::make_unique<Tapped>(card, log)};
  EXPECT_THAT(plug.codes, testing::Each(0x1000));
}

TEST_F(Card, IsRecognisedBeforeAnythingIsWrittenToIt) {
  const auto board = open();
  EXPECT_EQ(board->model(), 1);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(log_[i], (Access{'r', 0x603, 0}));
  state_.model = 2;
  log_.clear();
  EXPECT_EQ(open()->model(), 2);
}

TEST_F(Card, GetsZeroVoltsOnAllChannelsFirst) {
  const auto board = open();
  for (unsigned channel = 0; channel < 8; ++channel)
    EXPECT_EQ(log_[8 + channel], (Access{'W', 0x210 + 2 * channel, 0x1000}));
}

TEST_F(Card, CountersStartWithTheSequenceOfTheChipAndThePresetOfTheRigFile) {
  const auto board = open();
  // Channel 3, radial swing: data 0x205, control 0x207; the load hangs at 0.
  EXPECT_THAT(accesses_to({0x205, 0x207}),
              ElementsAre(Access{'w', 0x207, 0x20}, Access{'w', 0x207, 0x68}, Access{'w', 0x207, 0x80},
                          Access{'w', 0x207, 0xC3}, Access{'w', 0x207, 0x04},  //
                          Access{'w', 0x207, 0x01}, Access{'w', 0x205, 0x5A}, Access{'w', 0x205, 0x5A},
                          Access{'w', 0x205, 0x2A}, Access{'w', 0x207, 0x09}, Access{'w', 0x207, 0x03},
                          Access{'r', 0x205, 0}, Access{'r', 0x205, 0}, Access{'r', 0x205, 0},  //
                          Access{'w', 0x207, 0x01}, Access{'w', 0x205, 0xA6}, Access{'w', 0x205, 0xA5},
                          Access{'w', 0x205, 0xD5}, Access{'w', 0x207, 0x09}, Access{'w', 0x207, 0x03},
                          Access{'r', 0x205, 0}, Access{'r', 0x205, 0}, Access{'r', 0x205, 0},  //
                          Access{'w', 0x207, 0x01}, Access{'w', 0x205, 0}, Access{'w', 0x205, 0},
                          Access{'w', 0x205, 0}, Access{'w', 0x207, 0x09}));
}

TEST_F(Card, ReadsEveryCounterAfterLatchingItsPair) {
  const auto board = open();
  log_.clear();
  const auto inputs = board->read();
  EXPECT_EQ(inputs.raw_counts[0], 188976);  // 0.3 m
  EXPECT_EQ(log_[0], (Access{'W', 0x202, 0x0303}));
  EXPECT_EQ(log_[1], (Access{'W', 0x206, 0x0303}));
  EXPECT_EQ(log_[2], (Access{'W', 0x20A, 0x0303}));
  EXPECT_EQ(log_.size(), 3U + 2U + 5U * 3U + 2U);
  EXPECT_EQ(log_.back(), (Access{'r', 0x603, 0})) << "the board test";
}

/// The encoders move by one edge per port access, much faster than any drive.
TEST_F(Card, ReadsConsistentCountersThatAreLatchedWithinThreePortAccesses) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random{kSeed};
  std::uniform_int_distribution<std::int32_t> anywhere{-8'000'000, 8'000'000};
  auto board = open([this](const Access&) {
    for (auto& counts : plug_.turned) counts += 1;
  });
  const auto origin = plug_.turned[0];
  for (int i = 0; i < 1000; ++i) {
    const auto here = anywhere(random);
    plug_.turned.fill(origin + here);
    const auto first = board->read();
    plug_.turned.fill(origin + here);
    const auto second = board->read();
    // Equal positions give equal counts, even when a carry passes through the bytes between the accesses.
    EXPECT_EQ(first.raw_counts, second.raw_counts) << "seed " << kSeed;
    // Pairs are latched in consecutive accesses.
    EXPECT_EQ(first.raw_counts[4] - first.raw_counts[3], second.raw_counts[4] - second.raw_counts[3]);
  }
  plug_.turned.fill(origin);
  const auto low = board->read().raw_counts;
  plug_.turned.fill(origin + 0x00FFFF);
  const auto high = board->read().raw_counts;
  for (std::size_t i = 0; i < kCounters; ++i) EXPECT_EQ(high[i] - low[i], 0x00FFFF) << i;
}

TEST_F(Card, ATimerThatAnotherProgramStartedIsStopped) {
  card_.out_8(0x60E, 0x56);
  card_.out_8(0x60A, 0xB4);
  card_.out_8(0x60E, 0x34);
  card_.out_8(0x608, 40);  // 1 ms
  card_.out_8(0x608, 0);
  EXPECT_EQ(state_.timer_period_ns, 1'000'000);
  const auto board = open();
  EXPECT_EQ(state_.timer_period_ns, 0);
}

TEST_F(Card, TimerLatchesAllCountersAtTheEndOfItsPeriod) {
  const auto board = open();
  card_.out_8(0x60E, 0x56);
  card_.out_8(0x60A, 0xB4);
  card_.out_8(0x60E, 0x34);
  card_.out_8(0x608, 40);
  card_.out_8(0x608, 0);
  plug_.time_ns = 999'999;
  plug_.turned.fill(5);
  std::ignore = card_.in_8(0x603);
  plug_.time_ns = 1'000'000;
  plug_.turned.fill(6);
  std::ignore = card_.in_8(0x603);
  plug_.turned.fill(700);
  card_.out_8(0x207, 0x01);  // rewind without latching
  EXPECT_EQ(card_.in_8(0x205), 6);
  EXPECT_EQ(card_.in_16(0x204) >> 8, 0);  // the next byte of channel 3
}

TEST_F(Card, OutputsUseTheLinesOfTheRigFile) {
  const auto board = open();
  EXPECT_EQ(plug_.out, 0);
  board->write({{0, 0, 0}, {true, false, true}, true});
  EXPECT_EQ(plug_.out, 0b1101);  // C0, C2, C3
  EXPECT_EQ(accesses_to({0x606, 0x607}), (std::vector<Access>{{'w', 0x606, 0x92}, {'w', 0x607, 0x82}}));
  board->make_safe();
  EXPECT_EQ(plug_.out, 0);
}

TEST_F(Card, PortDOfModel2HasAnotherAddress) {
  rig_.wiring.watchdog_output = 24;
  state_.model = 2;
  const auto board = open();
  board->write({{}, {}, true});
  EXPECT_EQ(plug_.out, 0x0100);
  EXPECT_EQ(log_.back(), (Access{'w', 0x605, 1}));
}

TEST_F(Card, InputsAreActiveLowSoThatABrokenWireReadsAsTheUnsafeState) {
  const auto board = open();
  auto inputs = board->read();  // no encoder is connected
  EXPECT_TRUE(inputs.estop_pressed && inputs.watchdog_dropped && inputs.limit_low[0] && inputs.limit_high[2]);
  EXPECT_FALSE(inputs.brake_closed[0] || inputs.brake_closed[1] || inputs.brake_closed[2]);
  plug_.in = 0x0000;
  inputs = board->read();
  EXPECT_FALSE(inputs.estop_pressed || inputs.watchdog_dropped || inputs.limit_low[0] ||
               inputs.limit_high[2]);
  EXPECT_TRUE(inputs.brake_closed[0] && inputs.brake_closed[1] && inputs.brake_closed[2]);
  plug_.in = 1U << 4U;  // slew, high
  EXPECT_EQ(board->read().limit_high, (std::array<bool, kDrives>{false, true, false}));
}

/// No card: reads return the level of the open bus.
struct EmptySlot final : PortIo {
  int writes = 0;
  std::uint8_t in_8(std::uint16_t /*port*/) noexcept override { return 0xFF; }
  std::uint16_t in_16(std::uint16_t /*port*/) noexcept override { return 0xFFFF; }
  void out_8(std::uint16_t /*port*/, std::uint8_t /*value*/) noexcept override { ++writes; }
  void out_16(std::uint16_t /*port*/, std::uint16_t /*value*/) noexcept override { ++writes; }
};

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const BoardError& error) {
    return error.what();
  }
  return "accepted";
}

/// A card that can lose its power: then, all lines have the same level.
struct RemovableCard final : PortIo {
  explicit RemovableCard(PortIo& ports) : card{ports} {}
  PortIo& card;
  std::optional<std::uint8_t> level;
  std::uint8_t in_8(std::uint16_t port) noexcept override { return level ? *level : card.in_8(port); }
  std::uint16_t in_16(std::uint16_t port) noexcept override { return card.in_16(port); }
  void out_8(std::uint16_t port, std::uint8_t value) noexcept override {
    if (!level) card.out_8(port, value);
  }
  void out_16(std::uint16_t port, std::uint16_t value) noexcept override {
    if (!level) card.out_16(port, value);
  }
};

TEST(ServoToGo, ThatLosesItsPowerIsNamedAtTheNextReading) {
  for (const int model : {1, 2})
    for (const std::uint8_t level : {std::uint8_t{0x00}, std::uint8_t{0xFF}})
      for (int readings = 0; readings < 9; ++readings) {
        Plug plug;
        CardState state;
        state.model = model;
        EmulatedServoToGo emulated{0x200, state, plug};
        RemovableCard card{emulated};
        std::vector<Access> log;
        ServoToGo board{emulated_rig(), std::make_unique<Tapped>(card, log)};
        for (int i = 0; i < readings; ++i) std::ignore = board.read();
        card.level = level;
        EXPECT_THAT(refusal([&] { std::ignore = board.read(); }),
                    AllOf(HasSubstr("at 0x200 does not answer"), HasSubstr("power")));
      }
}

TEST(ServoToGo, AMissingBoardIsNamedAndNothingIsWritten) {
  EmptySlot slot;
  std::vector<Access> log;
  EXPECT_THAT(
      refusal([&] {
        const ServoToGo board{emulated_rig(), std::make_unique<Tapped>(slot, log)};
      }),
      AllOf(HasSubstr("no Servo-to-Go board at 0x200"), HasSubstr("0xff"), HasSubstr("base_address")));
  EXPECT_EQ(slot.writes, 0);
}

TEST_F(Card, ACounterThatDoesNotKeepItsValueIsNamedAndTheCardIsSafe) {
  plug_.codes.fill(0);
  EXPECT_THAT(refusal([this] {
                open([this](const Access& access) {
                  if (access.port == 0x209)
                    state_.counters[4].preset = {};  // channel 5 does not keep its value
                  if (access.port == 0x208)
                    state_.counters[4].preset = {};  // channel 4 does not keep its value either
                });
              }),
              AllOf(HasSubstr("counter 4"), HasSubstr("does not hold"), HasSubstr("0x2a5a5a")));
  EXPECT_THAT(plug_.codes, testing::Each(0x1000));
}

configuration::Rig with_wiring(const std::string& lines) {
  return configuration::parse_rig("extends = \"emulated_servo_to_go.toml\"\nname = \"x\"\n" + lines,
                                  CRANE_RIGS "/x.toml");
}

TEST(Wiring, ALineUsedTwiceAnAddressBetweenJumpersAndAScaleOfZeroAreRefusedTogether) {
  try {
    (void)with_wiring(
        "[wiring]\nestop_input = 7\nbase_address = 0x210\nwatchdog_output = 3\n"
        "[encoder.trolley]\ncounts_per_m = 0\n[encoder.slew]\nchannel = 3\n");
    FAIL() << "accepted";
  } catch (const configuration::ConfigurationError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("must be used once"), HasSubstr("0x200 + 0x20 n"),
                                    HasSubstr("wiring.watchdog_output = 3: must be an integer in [16, 31]"),
                                    HasSubstr("encoder.trolley.counts_per_m = 0"), HasSubstr("channel = 3")));
  }
}

}  // namespace
}  // namespace crane::bridge::test
