#include "crane/boards/servo_to_go.hpp"

#include <cstdio>

#include "crane/bridge/converter.hpp"
#include "crane/bridge/start_counts.hpp"
#include "registers.hpp"

namespace crane::bridge {
namespace {

using namespace servo_to_go;

std::string hex(unsigned value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", value);
  return text;
}

constexpr std::uint8_t byte_of(std::int64_t value, int index) {
  return static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * index));
}

constexpr std::int32_t sign_extended(std::uint32_t low_24_bits) {
  return static_cast<std::int32_t>(low_24_bits << 8) >> 8;
}

}  // namespace

ServoToGo::ServoToGo(const configuration::Rig& rig, std::unique_ptr<PortIo> ports)
    : ports_{std::move(ports)},
      base_{static_cast<std::uint16_t>(rig.wiring.base_address)},
      lines_{rig},
      model_{recognised_model()} {
  for (std::size_t i = 0; i < kDrives; ++i)
    converter_channel_[i] = static_cast<std::size_t>(rig.drives[i].dac_channel);
  const auto start = start_counts(rig);
  for (std::size_t i = 0; i < kCounters; ++i) {
    const auto& encoder = rig.encoders[i];
    if (encoder.counts_per_unit <= 0) continue;
    counters_[i] = {true, static_cast<std::size_t>(encoder.channel), start[i]};
    pair_used_[counters_[i].channel / 2] = true;
  }
  make_safe();
  ports_->out_8(at(kDirectionAbc), kAbInCOut);
  ports_->out_8(at(kDirectionD), kDOut);
  make_safe();  // a line may have any level at the time when it becomes an output
  stop_timer();
  for (const auto& counter : counters_)
    if (counter.used) start_counter(counter);
}

ServoToGo::~ServoToGo() { make_safe(); }

std::string_view ServoToGo::name() const {
  return model_ == 1 ? "servo_to_go model 1" : "servo_to_go model 2";
}

/// Reads the serial number: each of eight readings contains one bit and its index. The driver writes to no
/// port before this check.
int ServoToGo::recognised_model() const {
  unsigned serial = 0, seen = 0, reading = 0;
  for (std::size_t i = 0; i < kChannels; ++i) {
    reading = ports_->in_8(at(kBoardTest));
    const unsigned index = (reading >> 4) & 7U;
    seen |= 1U << index;
    serial |= (reading >> 7) << index;
  }
  if (seen == 0xFF && serial == kSerialModel1) return 1;
  if (seen == 0xFF && serial == kSerialModel2) return 2;
  throw BoardError("no Servo-to-Go board at " + hex(base_) + " (board test reads " + hex(reading) +
                   "): check the card, its address jumpers and base_address in [wiring] of the rig file");
}

/// Two successive readings of the board test contain successive indices, each with its bit of the
/// serial number. Without a card, both readings are equal.
void ServoToGo::check_presence() const {
  const unsigned serial = model_ == 1 ? kSerialModel1 : kSerialModel2;
  const auto index_of = [](unsigned reading) { return (reading >> 4) & 7U; };
  const auto has_its_bit = [&](unsigned reading) {
    return (reading >> 7) == ((serial >> index_of(reading)) & 1U);
  };
  const unsigned first = ports_->in_8(at(kBoardTest)), second = ports_->in_8(at(kBoardTest));
  if (has_its_bit(first) && has_its_bit(second) && index_of(second) == ((index_of(first) + 1) & 7U)) return;
  throw BoardError("the Servo-to-Go board at " + hex(base_) + " does not answer (board test reads " +
                   hex(second) + "): check that the card sits in its slot and has power");
}

/// A running timer would latch the counters while the driver reads their bytes.
void ServoToGo::stop_timer() noexcept {
  ports_->out_8(at(kTimerCommand), kTimerStop);
  ports_->out_8(at(kTimerCommand), kTimer0NoCount);
}

void ServoToGo::start_counter(const Counter& counter) {
  const auto control = at(counter_control(counter.channel));
  for (const auto command : {kMasterReset, kInputControl, kOutputControl, kQuadrature, kZero})
    ports_->out_8(control, command);
  // Between writing and reading, a moving encoder changes only the lowest bits.
  constexpr std::int32_t kTolerance_counts = 0x1000;
  for (const std::int32_t pattern : {0x2A5A5A, -0x2A5A5A}) {
    preset(counter.channel, pattern);
    ports_->out_8(control, kLatch);
    const auto found = latched(counter.channel);
    if (std::abs(found - pattern) <= kTolerance_counts) continue;
    throw BoardError("counter " + std::to_string(counter.channel) + " of the Servo-to-Go board at " +
                     hex(base_) + " does not hold a written value (" +
                     hex(static_cast<unsigned>(pattern) & 0xFFFFFFU) + " was read back as " +
                     hex(static_cast<unsigned>(found) & 0xFFFFFFU) +
                     "): use another channel, or another card");
  }
  preset(counter.channel, counter.start_counts);
}

void ServoToGo::preset(std::size_t channel, std::int64_t counts) noexcept {
  const auto control = at(counter_control(channel));
  ports_->out_8(control, kRewind);
  for (int i = 0; i < 3; ++i) ports_->out_8(at(counter_data(channel)), byte_of(counts, i));
  ports_->out_8(control, kPreset);
}

void ServoToGo::latch_all() noexcept {
  for (std::size_t pair = 0; pair < kChannels / 2; ++pair)
    if (pair_used_[pair]) ports_->out_16(at(counter_control(2 * pair)), kLatch << 8 | kLatch);
}

std::int32_t ServoToGo::latched(std::size_t channel) noexcept {
  const auto data = at(counter_data(channel));
  std::uint32_t value = ports_->in_8(data);
  value |= std::uint32_t{ports_->in_8(data)} << 8;
  value |= std::uint32_t{ports_->in_8(data)} << 16;
  return sign_extended(value);
}

std::uint16_t ServoToGo::input_levels() noexcept {
  const unsigned a = ports_->in_8(at(kPortA));
  const unsigned b = ports_->in_8(at(kPortB));
  return static_cast<std::uint16_t>(b << 8 | a);
}

Inputs ServoToGo::read() {
  latch_all();
  Inputs inputs;
  lines_.read(input_levels(), inputs);
  for (std::size_t i = 0; i < kCounters; ++i)
    if (counters_[i].used) inputs.raw_counts[i] = latched(counters_[i].channel);
  check_presence();  // last, so that all values above are those of a card
  return inputs;
}

std::array<double, kDrives> ServoToGo::write(const Outputs& outputs) {
  std::array<double, kDrives> given_v{};
  for (std::size_t i = 0; i < kDrives; ++i) {
    if (!lines_.present(i)) continue;
    const auto code = converter_code(outputs.drive_v[i]);
    ports_->out_16(at(converter(converter_channel_[i])), code);
    given_v[i] = converter_voltage_v(code);
  }
  set_outputs(lines_.outputs(outputs));
  return given_v;
}

void ServoToGo::set_outputs(std::uint32_t levels) noexcept {
  ports_->out_8(at(kPortC), static_cast<std::uint8_t>(levels >> 16));
  ports_->out_8(at(port_d(model_)), static_cast<std::uint8_t>(levels >> 24));
}

void ServoToGo::make_safe() noexcept {
  for (std::size_t channel = 0; channel < kChannels; ++channel)
    ports_->out_16(at(converter(channel)), kConverterZero);
  set_outputs(0);
}

}  // namespace crane::bridge
