#include "crane/boards/comedi.hpp"

#include <comedilib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "crane/boards/registry.hpp"
#include "crane/bridge/start_counts.hpp"

namespace crane::bridge {
namespace {

// smallest accepted range; a calibrated range ends just below 10 V
constexpr double kNeeded_v = 9.9;
constexpr int kFirstOutputLine = 16;
constexpr lsampl_t k24Bits = 0xFFFFFF;

constexpr std::int32_t counts_of_24_bits(lsampl_t value) {
  return static_cast<std::int32_t>(value << 8) >> 8;
}

unsigned output_bit(int line) { return 1U << static_cast<unsigned>(line - kFirstOutputLine); }

unsigned as_index(int value) { return static_cast<unsigned>(value); }

}  // namespace

Comedi::Handle::~Handle() {
  if (device != nullptr) ::comedi_close(device);
}

Comedi::Comedi(const configuration::Rig& rig) : wiring_{rig.wiring}, lines_{rig} {
  handle_.device = ::comedi_open(wiring_.device.c_str());
  if (handle_.device == nullptr)
    fail(std::string{"cannot be opened: "} + std::strerror(errno) +
         "; load its driver (comedi_config, lsmod), or correct device in [wiring]");
  name_ = std::string{"comedi "} + ::comedi_get_board_name(handle_.device);
  lock(wiring_.counter_subdevice, {COMEDI_SUBD_COUNTER}, "counter_subdevice");
  lock(wiring_.analog_output_subdevice, {COMEDI_SUBD_AO}, "analog_output_subdevice");
  lock(wiring_.input_subdevice, {COMEDI_SUBD_DIO, COMEDI_SUBD_DI}, "input_subdevice");
  lock(wiring_.output_subdevice, {COMEDI_SUBD_DIO, COMEDI_SUBD_DO}, "output_subdevice");
  const auto start = start_counts(rig);
  for (std::size_t i = 0; i < kCounters; ++i) {
    const auto& encoder = rig.encoders[i];
    if (encoder.counts_per_unit <= 0) continue;
    counters_.push_back({i, as_index(encoder.channel), start[i]});
    require_channel(wiring_.counter_subdevice, as_index(encoder.channel), "counter_subdevice");
  }
  for (std::size_t i = 0; i < kDrives; ++i)
    if (lines_.present(i)) find_converter(i, as_index(rig.drives[i].dac_channel));
  make_safe();
  find_lines();
  make_safe();  // a line may have any level at the time when it becomes an output
  for (const auto& counter : counters_) start_counter(counter);
}

Comedi::~Comedi() { make_safe(); }

void Comedi::fail(const std::string& what) const {
  throw BoardError("comedi device " + wiring_.device + ": " + what);
}

void Comedi::lock(int subdevice, std::initializer_list<int> types, const char* key) {
  const auto index = as_index(subdevice);
  const auto place = std::string{key} + " = " + std::to_string(subdevice);
  if (subdevice >= ::comedi_get_n_subdevices(handle_.device) ||
      std::ranges::find(types, ::comedi_get_subdevice_type(handle_.device, index)) == types.end())
    fail(place + " does not exist on " + name_ +
         " or has another type: correct [wiring] (`comedi_board_info` lists the subdevices)");
  if (::comedi_lock(handle_.device, index) != 0) fail(place + " is in use by another program: stop it first");
}

void Comedi::require_channel(int subdevice, unsigned channel, const char* key) const {
  const int channels = ::comedi_get_n_channels(handle_.device, as_index(subdevice));
  if (static_cast<int>(channel) >= channels)
    fail(std::string{key} + " has " + std::to_string(channels) + " channels, but the rig file uses channel " +
         std::to_string(channel));
}

void Comedi::find_converter(std::size_t drive, unsigned channel) {
  const auto subdevice = as_index(wiring_.analog_output_subdevice);
  require_channel(wiring_.analog_output_subdevice, channel, "analog_output_subdevice");
  const int ranges = ::comedi_get_n_ranges(handle_.device, subdevice, channel);
  for (unsigned range = 0; static_cast<int>(range) < ranges; ++range) {
    const auto* found = ::comedi_get_range(handle_.device, subdevice, channel, range);
    if (found == nullptr || found->unit != UNIT_volt || found->min > -kNeeded_v || found->max < kNeeded_v)
      continue;
    converters_.push_back({drive, channel, range, found->min, found->max,
                           ::comedi_get_maxdata(handle_.device, subdevice, channel)});
    return;
  }
  fail("analog output " + std::to_string(channel) + " has no range of +-10 V: use another board");
}

/// Sets the directions of all lines in use whose direction can be set.
void Comedi::find_lines() {
  const auto direct = [this](int subdevice, int channel, unsigned direction, const char* key) {
    require_channel(subdevice, as_index(channel), key);
    const bool fixed = ::comedi_get_subdevice_type(handle_.device, as_index(subdevice)) != COMEDI_SUBD_DIO;
    if (!fixed && ::comedi_dio_config(handle_.device, as_index(subdevice), as_index(channel), direction) < 0)
      fail(std::string{key} + ": channel " + std::to_string(channel) + " does not accept its direction");
  };
  const auto input = [&](int line) {
    direct(wiring_.input_subdevice, line, COMEDI_INPUT, "input_subdevice");
  };
  const auto output = [&](int line) {
    direct(wiring_.output_subdevice, line - kFirstOutputLine, COMEDI_OUTPUT, "output_subdevice");
    output_mask_ |= output_bit(line);
  };
  input(wiring_.estop_input);
  input(wiring_.relay_closed_input);
  output(wiring_.watchdog_output);
  for (std::size_t i = 0; i < kDrives; ++i) {
    if (!lines_.present(i)) continue;
    const auto& lines = wiring_.drives[i];
    for (const int line : {lines.limit_low_input, lines.limit_high_input, lines.brake_closed_input})
      input(line);
    if (lines.mark_input >= 0) input(lines.mark_input);
    output(lines.brake_release_output);
  }
}

void Comedi::start_counter(const Counter& counter) {
  const auto subdevice = as_index(wiring_.counter_subdevice);
  const auto label = "counter " + std::to_string(counter.channel);
  if (::comedi_get_maxdata(handle_.device, subdevice, counter.channel) < k24Bits)
    fail(label + " has fewer than 24 bits: use another board");
  if (::comedi_set_counter_mode(handle_.device, subdevice, counter.channel,
                                NI_GPCT_COUNTING_MODE_QUADRATURE_X4_BITS) < 0 ||
      ::comedi_arm_channel(handle_.device, subdevice, counter.channel, NI_GPCT_ARM_IMMEDIATE) < 0)
    fail(label + " does not count quadrature: use another board");
  // The counter is preset last: some drivers reset the counter at every configuration.
  const auto wanted = static_cast<lsampl_t>(counter.start_counts) & k24Bits;
  lsampl_t found = 0;
  if (::comedi_data_write(handle_.device, subdevice, counter.channel, 0, AREF_GROUND, wanted) < 0 ||
      ::comedi_data_read(handle_.device, subdevice, counter.channel, 0, AREF_GROUND, &found) < 0)
    fail(label + " does not answer");
  // Between writing and reading, a moving encoder changes only the lowest bits.
  constexpr std::int32_t kTolerance_counts = 0x1000;
  if (std::abs(counts_of_24_bits(found - wanted)) > kTolerance_counts)
    fail(label + " does not hold a written value: use another channel, or another board");
}

Inputs Comedi::read() {
  std::array<lsampl_t, kCounters> values{};
  std::array<lsampl_t, 2> lines{0, 0};  // writes no line, reads all lines
  std::array<comedi_insn, kCounters + 1> instructions{};
  unsigned count = 0;
  for (const auto& counter : counters_) {
    instructions[count] = {INSN_READ,
                           1,
                           &values[count],
                           as_index(wiring_.counter_subdevice),
                           CR_PACK(counter.channel, 0, AREF_GROUND),
                           {}};
    ++count;
  }
  instructions[count] = {INSN_BITS, 2, lines.data(), as_index(wiring_.input_subdevice), 0, {}};
  comedi_insnlist list{count + 1, instructions.data()};
  if (::comedi_do_insnlist(handle_.device, &list) != static_cast<int>(count + 1))
    fail("cannot be read any more");

  Inputs inputs;
  for (std::size_t i = 0; i < counters_.size(); ++i)
    inputs.raw_counts[counters_[i].coordinate] = counts_of_24_bits(values[i]);
  lines_.read(lines[1], inputs);
  return inputs;
}

unsigned Comedi::code(const Converter& converter, double voltage_v) const noexcept {
  comedi_range range{converter.low_v, converter.high_v, UNIT_volt};
  const double finite_v = std::isfinite(voltage_v) ? voltage_v : 0;
  return ::comedi_from_phys(std::clamp(finite_v, range.min, range.max), &range, converter.largest);
}

/// comedi_to_phys() is not used: it returns NaN for the first and the last code.
double Comedi::voltage_v(const Converter& converter, unsigned code) const noexcept {
  return converter.low_v + code * (converter.high_v - converter.low_v) / converter.largest;
}

std::array<double, kDrives> Comedi::write(const Outputs& outputs) {
  const auto subdevice = as_index(wiring_.analog_output_subdevice);
  std::array<double, kDrives> given_v{};
  for (const auto& converter : converters_) {
    const auto value = code(converter, outputs.drive_v[converter.drive]);
    if (::comedi_data_write(handle_.device, subdevice, converter.channel, converter.range, AREF_GROUND,
                            value) < 0)
      fail("analog output " + std::to_string(converter.channel) + " cannot be written any more");
    given_v[converter.drive] = voltage_v(converter, value);
  }
  unsigned bits = lines_.outputs(outputs) >> kFirstOutputLine;
  if (::comedi_dio_bitfield2(handle_.device, as_index(wiring_.output_subdevice), output_mask_, &bits, 0) < 0)
    fail("outputs cannot be written any more");
  return given_v;
}

/// Sets every output, even if a previous output has failed.
void Comedi::make_safe() noexcept {
  for (const auto& converter : converters_)
    ::comedi_data_write(handle_.device, as_index(wiring_.analog_output_subdevice), converter.channel,
                        converter.range, AREF_GROUND, code(converter, 0));
  unsigned bits = 0;
  if (output_mask_ != 0)
    ::comedi_dio_bitfield2(handle_.device, as_index(wiring_.output_subdevice), output_mask_, &bits, 0);
}

std::unique_ptr<Board> make_comedi_board(const configuration::Rig& rig, const bus::Options& /*bus*/) {
  return std::make_unique<Comedi>(rig);
}

}  // namespace crane::bridge
