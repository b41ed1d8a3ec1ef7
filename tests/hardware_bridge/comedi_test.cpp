// The comedi driver with the stand-in: call order, ranges, units, refusals.
#include "crane/boards/comedi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "comedi_stand_in.hpp"
#include "subject.hpp"

namespace crane::bridge::test {
namespace {

configuration::Rig comedi_rig() {
  auto rig = emulated_rig();
  rig.board = "comedi";
  return rig;
}

std::ptrdiff_t first_of(const std::vector<std::string>& calls, const std::string& beginning) {
  const auto found = std::find_if(calls.begin(), calls.end(),
                                  [&](const std::string& call) { return call.rfind(beginning, 0) == 0; });
  EXPECT_NE(found, calls.end()) << beginning;
  return found - calls.begin();
}

TEST(ComediBoard, LocksThenSetsZeroVoltsThenDirectionsThenCounters) {
  ComediStandIn device{comedi_rig()};
  const Comedi board{comedi_rig()};
  const auto& calls = device.calls();
  for (const char* subdevice : {"lock 1", "lock 2", "lock 3", "lock 5"})
    EXPECT_LT(first_of(calls, subdevice), first_of(calls, "volts"));
  EXPECT_LT(first_of(calls, "volts 2"), first_of(calls, "direction"));
  EXPECT_LT(first_of(calls, "bits 3"), first_of(calls, "mode"));
  EXPECT_LT(first_of(calls, "mode 0"), first_of(calls, "arm 0"));
  EXPECT_LT(first_of(calls, "arm 0"), first_of(calls, "preset 0 188976"));  // 0.3 m
  for (const auto& call : calls)
    if (call.rfind("volts", 0) == 0) {
      EXPECT_EQ(call.substr(8), "4095") << "0 V of " << call;
    }
}

TEST(ComediBoard, ReadsAllCountersAndInputsInOneList) {
  ComediStandIn device{comedi_rig()};
  Comedi board{comedi_rig()};
  const auto before = device.calls().size();
  std::ignore = board.read();
  ASSERT_GT(device.calls().size(), before);
  EXPECT_EQ(device.calls()[before], "list 6");
}

TEST(ComediBoard, EndsWithZeroVoltsAndOutputsOff) {
  ComediStandIn device{comedi_rig()};
  {
    Comedi board{comedi_rig()};
    board.write({{5, -5, 1}, {true, true, true}, true});
  }
  const auto& calls = device.calls();
  EXPECT_EQ(calls.back(), "bits 3 15 0");
  EXPECT_EQ(calls[calls.size() - 4], "volts 0 4095");
}

TEST(ComediBoard, LinesOfAFixedDirectionKeepTheirDirection) {
  ComediStandIn device{comedi_rig()};
  device.fixed_lines = true;
  Comedi board{comedi_rig()};
  board.write({{}, {false, false, false}, true});
  EXPECT_EQ(device.calls().back(), "bits 3 15 8");
  EXPECT_FALSE(board.read().estop_pressed);
}

TEST(ComediBoard, ReportsTheVoltsOfTheFirstAndTheLastCode) {
  ComediStandIn device{comedi_rig()};
  Comedi board{comedi_rig()};
  const auto given_v = board.write({{99, -99, 0}, {}, false});
  EXPECT_NEAR(given_v[0], 10, 20.0 / 8191);  // one end of the range is one step below 10 V
  EXPECT_NEAR(given_v[1], -10, 20.0 / 8191);
}

/// Message of a failed opening. The stand-in checks that everything is closed again.
std::string refusal(const std::function<void(ComediStandIn&, configuration::Rig&)>& spoil) {
  auto rig = comedi_rig();
  ComediStandIn device{rig};
  spoil(device, rig);
  try {
    const Comedi board{rig};
  } catch (const BoardError& error) {
    return error.what();
  }
  return "";
}

TEST(ComediBoard, RefusesWithOneLineAndTheRemedy) {
  const auto expect = [](const std::string& part,
                         const std::function<void(ComediStandIn&, configuration::Rig&)>& spoil) {
    const auto message = refusal(spoil);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find("comedi device /dev/comedi0: "), 0U) << message;
  };
  expect("cannot be opened", [](auto& device, auto&) { device.there = false; });
  expect("analog_output_subdevice = 1 is in use", [](auto& device, auto&) { device.locked_by_another = 1; });
  expect("counter_subdevice = 4 does not exist on comedi stand-in",
         [](auto&, auto& rig) { rig.wiring.counter_subdevice = 4; });
  expect("input_subdevice = 60 does not exist on comedi stand-in",
         [](auto&, auto& rig) { rig.wiring.input_subdevice = 60; });
  expect("fewer than 24 bits", [](auto& device, auto&) { device.largest_count = 0xFFFF; });
  expect("no range of +-10 V", [](auto& device, auto&) { device.range_v = 5; });
  expect("does not hold", [](auto& device, auto&) { device.stuck_counter = 3; });
  expect("6 channels, but the rig file uses channel 7",
         [](auto&, auto& rig) { rig.encoders[2].channel = 7; });
}

TEST(ComediBoard, ReportsADeviceThatNoLongerAnswers) {
  ComediStandIn device{comedi_rig()};
  Comedi board{comedi_rig()};
  device.answers = false;
  EXPECT_THROW(std::ignore = board.read(), BoardError);
  EXPECT_THROW(board.write({}), BoardError);
  board.make_safe();
  device.answers = true;
}

}  // namespace
}  // namespace crane::bridge::test
