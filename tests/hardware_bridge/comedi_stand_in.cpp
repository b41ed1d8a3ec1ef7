#include "comedi_stand_in.hpp"

#include <comedilib.h>
#include <gtest/gtest.h>

#include <cmath>

namespace crane::bridge::test {
namespace {

ComediStandIn* there_is = nullptr;

ComediStandIn& stand_in() {
  if (there_is == nullptr) throw std::logic_error("a function of comedi without a device");
  return *there_is;
}

std::string call(const char* what, std::initializer_list<unsigned> numbers) {
  std::string text{what};
  for (const auto number : numbers) text += ' ' + std::to_string(number);
  return text;
}

}  // namespace

ComediStandIn::ComediStandIn(const configuration::Rig& rig) : rig_{rig} {
  if (there_is != nullptr) throw std::logic_error("one device at a time");
  there_is = this;
}

ComediStandIn::~ComediStandIn() {
  EXPECT_FALSE(open_) << "the driver has to close what it has opened";
  there_is = nullptr;
}

void ComediStandIn::require(bool kept, const char* rule) const {
  if (!kept) ADD_FAILURE() << rule << (calls_.empty() ? "" : ", after " + calls_.back());
}

bool ComediStandIn::open() {
  require(!open_, "opened twice");
  note("open");
  return open_ = there;
}

void ComediStandIn::close() {
  require(open_, "closed, but not open");
  open_ = false;
  locked_.fill(false);
}

int ComediStandIn::lock(unsigned subdevice) {
  require(open_ && subdevice < kSubdevices, "lock: device open, subdevice there");
  note(call("lock", {subdevice}));
  if (subdevice == locked_by_another) return -1;
  locked_[subdevice] = true;
  return 0;
}

void ComediStandIn::require_locked(unsigned subdevice) const {
  require(open_ && subdevice < kSubdevices && locked_[subdevice], "used without its lock");
}

int ComediStandIn::configure(unsigned channel, const char* what) {
  require_locked(kCountersAt);
  note(call(what, {channel}));
  ++counter_configured_[channel];
  return 0;
}

int ComediStandIn::write(unsigned subdevice, unsigned channel, unsigned range, unsigned value) {
  require_locked(subdevice);
  if (!answers) return -1;
  if (subdevice == kCountersAt) {
    require(counter_configured_[channel] == 2, "a counter is preset after its mode and its start");
    require(value <= 0xFFFFFF, "a count of 24 bits");
    note(call("preset", {channel, value}));
    origin_[channel] = static_cast<std::uint32_t>(rig_.pulses(channel)) - value;
    return 1;
  }
  require(subdevice == kAnalogOutputs && range == kGoodRange && value <= kLargestCode,
          "code within the range");
  note(call("volts", {channel, value}));
  rig_.set_converter(channel, static_cast<std::uint16_t>(kLargestCode - value));
  return 1;
}

int ComediStandIn::read(unsigned subdevice, unsigned channel, unsigned& value) {
  require_locked(subdevice);
  if (!answers) return -1;
  value = channel == stuck_counter
              ? 0x555555U
              : (static_cast<std::uint32_t>(rig_.pulses(channel)) - origin_[channel]) & largest_count;
  return 1;
}

int ComediStandIn::direct(unsigned subdevice, unsigned channel, unsigned direction) {
  require_locked(subdevice);
  require(channel < kChannels && !fixed_lines, "channel there, with a direction to choose");
  note(call("direction", {subdevice, channel, direction}));
  (direction == COMEDI_OUTPUT ? outputs_set_ : inputs_set_)[subdevice] |= 1U << channel;
  return 0;
}

int ComediStandIn::bits(unsigned subdevice, unsigned mask, unsigned& value) {
  require_locked(subdevice);
  if (!answers) return -1;
  require(fixed_lines || (mask & ~outputs_set_[subdevice]) == 0, "only outputs are written");
  note(call("bits", {subdevice, mask, value}));
  if (subdevice == kOutputs) {
    output_levels_ = (output_levels_ & ~mask) | (value & mask);
    rig_.set_outputs(static_cast<std::uint16_t>(output_levels_));
  }
  value = subdevice == kInputs ? rig_.inputs() : output_levels_;
  return 0;
}

}  // namespace crane::bridge::test

using crane::bridge::test::ComediStandIn;
using crane::bridge::test::stand_in;

// NOLINTBEGIN(readability-identifier-naming): names of libcomedi
extern "C" {

comedi_t* comedi_open(const char* file) {
  stand_in().require(std::string{file} == "/dev/comedi0", "device of the rig file");
  return stand_in().open() ? reinterpret_cast<comedi_t*>(&stand_in()) : nullptr;
}
int comedi_close(comedi_t*) { return stand_in().close(), 0; }
const char* comedi_get_board_name(comedi_t*) { return "stand-in"; }
int comedi_get_n_subdevices(comedi_t*) { return ComediStandIn::kSubdevices; }
int comedi_get_subdevice_type(comedi_t*, unsigned subdevice) {
  switch (subdevice) {
    case ComediStandIn::kAnalogOutputs:
      return COMEDI_SUBD_AO;
    case ComediStandIn::kInputs:
      return stand_in().fixed_lines ? COMEDI_SUBD_DI : COMEDI_SUBD_DIO;
    case ComediStandIn::kOutputs:
      return stand_in().fixed_lines ? COMEDI_SUBD_DO : COMEDI_SUBD_DIO;
    case ComediStandIn::kCountersAt:
      return COMEDI_SUBD_COUNTER;
    default:
      return COMEDI_SUBD_AI;
  }
}
int comedi_get_n_channels(comedi_t*, unsigned subdevice) {
  return subdevice == ComediStandIn::kCountersAt ? 6 : ComediStandIn::kChannels;
}
int comedi_lock(comedi_t*, unsigned subdevice) { return stand_in().lock(subdevice); }
lsampl_t comedi_get_maxdata(comedi_t*, unsigned subdevice, unsigned) {
  return subdevice == ComediStandIn::kCountersAt ? stand_in().largest_count : ComediStandIn::kLargestCode;
}
int comedi_get_n_ranges(comedi_t*, unsigned, unsigned) { return 2; }
/// Output ranges: ±5 V, then a range with the step of the 13-bit converters of the simulated crane.
comedi_range* comedi_get_range(comedi_t*, unsigned, unsigned, unsigned range) {
  static comedi_range found;
  const double limit_v = range == ComediStandIn::kGoodRange ? stand_in().range_v : 5;
  found = {-limit_v + limit_v / 4096, limit_v, UNIT_volt};
  return &found;
}
lsampl_t comedi_from_phys(double value, comedi_range* range, lsampl_t largest) {
  EXPECT_TRUE(value >= range->min && value <= range->max) << value;
  return static_cast<lsampl_t>(std::llround((value - range->min) / (range->max - range->min) * largest));
}
int comedi_set_counter_mode(comedi_t*, unsigned subdevice, unsigned channel, unsigned mode) {
  stand_in().require(
      subdevice == ComediStandIn::kCountersAt && mode == NI_GPCT_COUNTING_MODE_QUADRATURE_X4_BITS,
      "four counts a line");
  return stand_in().configure(channel, "mode");
}
int comedi_arm_channel(comedi_t*, unsigned, unsigned channel, unsigned) {
  return stand_in().configure(channel, "arm");
}
int comedi_data_write(comedi_t*, unsigned subdevice, unsigned channel, unsigned range, unsigned,
                      lsampl_t value) {
  return stand_in().write(subdevice, channel, range, value);
}
int comedi_data_read(comedi_t*, unsigned subdevice, unsigned channel, unsigned, unsigned, lsampl_t* value) {
  return stand_in().read(subdevice, channel, *value);
}
int comedi_dio_config(comedi_t*, unsigned subdevice, unsigned channel, unsigned direction) {
  return stand_in().direct(subdevice, channel, direction);
}
int comedi_dio_bitfield2(comedi_t*, unsigned subdevice, unsigned mask, unsigned* bits, unsigned base) {
  stand_in().require(base == 0, "from channel 0");
  return stand_in().bits(subdevice, mask, *bits);
}
int comedi_do_insnlist(comedi_t*, comedi_insnlist* list) {
  stand_in().note("list " + std::to_string(list->n_insns));
  unsigned done = 0;
  for (; done < list->n_insns; ++done) {
    const auto& one = list->insns[done];
    const int result = one.insn == INSN_BITS
                           ? stand_in().bits(one.subdev, one.data[0], one.data[1])
                           : stand_in().read(one.subdev, CR_CHAN(one.chanspec), one.data[0]);
    if (result < 0) break;
  }
  return static_cast<int>(done);
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
