/// The comedi driver with the comedi modules of the kernel in a virtual machine: analog outputs of
/// comedi_test, measured by its inputs, and lines of the parallel port. The wrappers below replace only the
/// functions that these devices do not have.
#include <comedilib.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/io.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "crane/boards/comedi.hpp"

namespace {
constexpr unsigned kLent = 10;  // first replaced subdevice
constexpr int kLentTypes[] = {COMEDI_SUBD_COUNTER, COMEDI_SUBD_AO, COMEDI_SUBD_DI, COMEDI_SUBD_DO};
unsigned lent_outputs = 0;
}  // namespace

// NOLINTBEGIN(readability-identifier-naming,bugprone-reserved-identifier): names of the linker
extern "C" {
int __real_comedi_get_subdevice_type(comedi_t*, unsigned);
int __real_comedi_lock(comedi_t*, unsigned);
int __real_comedi_get_n_channels(comedi_t*, unsigned);
int __real_comedi_dio_bitfield2(comedi_t*, unsigned, unsigned, unsigned*, unsigned);

int __wrap_comedi_get_n_subdevices(comedi_t*) { return kLent + std::size(kLentTypes); }
int __wrap_comedi_get_subdevice_type(comedi_t* device, unsigned subdevice) {
  return subdevice < kLent ? __real_comedi_get_subdevice_type(device, subdevice)
                           : kLentTypes[subdevice - kLent];
}
int __wrap_comedi_lock(comedi_t* device, unsigned subdevice) {
  return subdevice < kLent ? __real_comedi_lock(device, subdevice) : 0;
}
int __wrap_comedi_get_n_channels(comedi_t* device, unsigned subdevice) {
  return subdevice < kLent ? __real_comedi_get_n_channels(device, subdevice) : 16;
}
int __wrap_comedi_dio_bitfield2(comedi_t* device, unsigned subdevice, unsigned mask, unsigned* bits,
                                unsigned base) {
  if (subdevice < kLent) return __real_comedi_dio_bitfield2(device, subdevice, mask, bits, base);
  lent_outputs = (lent_outputs & ~mask) | (*bits & mask);
  return 0;
}
}
// NOLINTEND(readability-identifier-naming,bugprone-reserved-identifier)

namespace crane::bridge {
namespace {

using testing::HasSubstr;

constexpr const char* kTestDevice = "/dev/comedi1";  // comedi_test: 0 analog inputs, 1 analog outputs
constexpr const char* kPortDevice = "/dev/comedi0";  // comedi_parport: 0 data, 1 status, 2 control
constexpr unsigned short kPort = 0x378;

/// All subdevices are replaced; no axis.
configuration::Rig lent_rig(const char* device) {
  configuration::Rig rig;
  rig.wiring.device = device;
  rig.wiring.counter_subdevice = kLent;
  rig.wiring.analog_output_subdevice = kLent + 1;
  rig.wiring.input_subdevice = kLent + 2;
  rig.wiring.output_subdevice = kLent + 3;
  return rig;
}

/// Three axes on the channels 2, 0 and 5 of the kernel's analog outputs.
configuration::Rig analog_rig() {
  auto rig = lent_rig(kTestDevice);
  rig.wiring.analog_output_subdevice = 1;
  constexpr int kChannels[] = {2, 0, 5};
  for (std::size_t i = 0; i < kDrives; ++i) {
    rig.drives[i].present = true;
    rig.drives[i].dac_channel = kChannels[i];
  }
  return rig;
}

std::string refusal(const configuration::Rig& rig) {
  try {
    const Comedi board{rig};
  } catch (const BoardError& error) {
    return error.what();
  }
  return "";
}

/// Levels at the terminals, read by another program.
class Voltmeter {
 public:
  Voltmeter() : device_{comedi_open(kTestDevice)} {}
  ~Voltmeter() { comedi_close(device_); }
  Voltmeter(const Voltmeter&) = delete;
  Voltmeter& operator=(const Voltmeter&) = delete;
  [[nodiscard]] double volts(unsigned channel) const {
    lsampl_t code = 0;
    EXPECT_EQ(comedi_data_read(device_, 0, channel, 0, AREF_GROUND, &code), 1);
    const auto* range = comedi_get_range(device_, 0, channel, 0);
    return range->min + code * (range->max - range->min) / comedi_get_maxdata(device_, 0, channel);
  }

 private:
  comedi_t* device_;
};

constexpr double kStep_v = 20.0 / 65535;  // 16 bit over +-10 V

TEST(ComediKernel, RefusesAMissingDevice) {
  EXPECT_THAT(refusal(lent_rig("/dev/comedi9")), HasSubstr("cannot be opened: No such file or directory"));
}

TEST(ComediKernel, RefusesEverySubdeviceThatIsNotOfItsKindByItsKey) {
  const auto expect = [](int configuration::Wiring::*key, int subdevice, const std::string& name) {
    auto rig = lent_rig(kTestDevice);
    rig.wiring.*key = subdevice;
    EXPECT_EQ(refusal(rig), std::string{"comedi device "} + kTestDevice + ": " + name + " = " +
                                std::to_string(subdevice) +
                                " does not exist on comedi comedi_test or has another type: correct [wiring] "
                                "(`comedi_board_info` lists the subdevices)");
  };
  for (const int subdevice : {0, 1, 2}) {  // analog inputs, analog outputs, nothing
    expect(&configuration::Wiring::counter_subdevice, subdevice, "counter_subdevice");
    expect(&configuration::Wiring::input_subdevice, subdevice, "input_subdevice");
    expect(&configuration::Wiring::output_subdevice, subdevice, "output_subdevice");
    if (subdevice != 1)
      expect(&configuration::Wiring::analog_output_subdevice, subdevice, "analog_output_subdevice");
  }
}

TEST(ComediKernel, RefusesASecondUserAndAMissingChannel) {
  auto rig = analog_rig();
  {
    const Comedi board{rig};
    EXPECT_THAT(refusal(rig), HasSubstr("analog_output_subdevice = 1 is in use by another program"));
  }
  EXPECT_EQ(refusal(rig), "");
  rig.drives[1].dac_channel = 8;
  EXPECT_THAT(refusal(rig),
              HasSubstr("analog_output_subdevice has 8 channels, but the rig file uses channel 8"));
}

TEST(ComediKernel, TheTerminalsShowTheVoltsThatWereWrittenAndReported) {
  Comedi board{analog_rig()};
  const Voltmeter meter;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::array<double, 3> wanted[] = {
      {0, 0, 0}, {1, -2, 3}, {9.99, -9.99, 0.001}, {99, -99, 10}, {kNone, 5, -1e300}};
  for (const auto& volts : wanted) {
    const auto given_v = board.write({volts, {}, false});
    constexpr unsigned kChannels[] = {2, 0, 5};
    for (std::size_t i = 0; i < kDrives; ++i) {
      const double expected_v = std::isfinite(volts[i]) ? std::clamp(volts[i], -10.0, 10.0) : 0;
      EXPECT_NEAR(given_v[i], expected_v, 0.51 * kStep_v);
      EXPECT_NEAR(meter.volts(kChannels[i]), given_v[i], 1e-12);
    }
  }
}

TEST(ComediKernel, ZeroVoltsWhenItOpensAndWhenItEnds) {
  const Voltmeter meter;
  {
    Comedi board{analog_rig()};
    EXPECT_NEAR(meter.volts(2), 0, kStep_v);
    board.write({{7, 7, 7}, {true, true, true}, true});
    EXPECT_NEAR(meter.volts(5), 7, kStep_v);
    EXPECT_EQ(lent_outputs, 0b1111U);
  }
  for (const unsigned channel : {2U, 0U, 5U}) EXPECT_NEAR(meter.volts(channel), 0, kStep_v);
  EXPECT_EQ(lent_outputs, 0U);
}

class ParallelPort : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    ASSERT_EQ(::ioperm(kPort, 3, 1), 0);
    comedi_devconfig configuration{};
    std::strcpy(configuration.board_name, "comedi_parport");
    configuration.options[0] = kPort;
    const int file = ::open(kPortDevice, O_RDWR);
    ASSERT_EQ(::ioctl(file, COMEDI_DEVCONFIG, &configuration), 0) << std::strerror(errno);
    ::close(file);
  }
  static configuration::Rig port_rig() {
    auto rig = lent_rig(kPortDevice);
    rig.wiring.input_subdevice = 1;
    rig.wiring.output_subdevice = 0;
    rig.wiring.relay_closed_input = 3;
    return rig;
  }
};

TEST_F(ParallelPort, ReadsItsInputsInOneListOfInstructions) {
  const auto status = static_cast<unsigned>(inb(kPort + 1)) >> 3;
  for (int estop = 0; estop < 5; ++estop) {
    auto rig = port_rig();
    rig.wiring.estop_input = estop;
    rig.wiring.relay_closed_input = (estop + 1) % 5;
    const auto inputs = Comedi{rig}.read();
    EXPECT_EQ(inputs.estop_pressed, (status >> estop & 1U) != 0);
    EXPECT_EQ(inputs.watchdog_dropped, (status >> (estop + 1) % 5 & 1U) != 0);
  }
}

TEST_F(ParallelPort, TogglesTheWatchdogOutputAndLeavesItOff) {
  {
    Comedi board{port_rig()};
    for (const bool level : {true, false, true}) {
      board.write({{}, {}, level});
      EXPECT_EQ(inb(kPort), level ? 1U << 3 : 0U);
    }
  }
  EXPECT_EQ(inb(kPort), 0U);
}

TEST_F(ParallelPort, RefusesInputsAsOutputsAndMoreLinesThanThereAre) {
  auto rig = port_rig();
  std::swap(rig.wiring.input_subdevice, rig.wiring.output_subdevice);
  EXPECT_THAT(refusal(rig), HasSubstr("output_subdevice = 1 does not exist on comedi"));
  rig = port_rig();
  rig.wiring.estop_input = 5;
  EXPECT_THAT(refusal(rig), HasSubstr("input_subdevice has 5 channels, but the rig file uses channel 5"));
}

}  // namespace
}  // namespace crane::bridge
