#include "crane/boards/emulated_servo_to_go.hpp"

#include "../servo_to_go/registers.hpp"
#include "crane/bridge/converter.hpp"

namespace crane::bridge {
namespace {

using namespace servo_to_go;

constexpr std::uint32_t k24Bits = 0xFFFFFF;
constexpr std::uint8_t kNothingThere = 0xFF;
constexpr double kTimerClock_hz = 7.2e6;
constexpr std::uint16_t kCounterRegisters = 0x10;  // data at offsets 0, 1, 4, 5, ...; control 2 further

bool is_counter(std::uint16_t offset) { return offset < kCounterRegisters; }
bool is_control(std::uint16_t offset) { return (offset & 2U) != 0; }
std::size_t channel_of(std::uint16_t offset) { return (std::size_t{offset} >> 2U) << 1U | (offset & 1U); }

bool counts(const CardState::Counter& counter) {
  constexpr std::uint8_t kInputsEnabled = 0x08, kTimesFour = 0x03;
  return (counter.input_control & kInputsEnabled) != 0 && (counter.quadrature & 3U) == kTimesFour;
}

}  // namespace

std::uint8_t EmulatedServoToGo::in_8(std::uint16_t port) noexcept {
  let_time_pass();
  const auto offset = static_cast<std::uint16_t>(port - base_);
  if (is_counter(offset)) return is_control(offset) ? kNothingThere : next_latched_byte(channel_of(offset));
  if (offset == kBoardTest) return board_test();
  if (offset == kPortA) return static_cast<std::uint8_t>(connector_.inputs());
  if (offset == kPortB) return static_cast<std::uint8_t>(connector_.inputs() >> 8U);
  if (offset == kPortC && state_.c_is_output) return state_.output_latch[0];
  if (offset == port_d(state_.model) && state_.d_is_output) return state_.output_latch[1];
  return kNothingThere;
}

std::uint16_t EmulatedServoToGo::in_16(std::uint16_t port) noexcept {
  const unsigned low = in_8(port);
  const unsigned high = in_8(static_cast<std::uint16_t>(port + 1));
  return static_cast<std::uint16_t>(high << 8U | low);
}

void EmulatedServoToGo::out_8(std::uint16_t port, std::uint8_t value) noexcept {
  let_time_pass();
  const auto offset = static_cast<std::uint16_t>(port - base_);
  if (is_counter(offset)) {
    auto& counter = state_.counters[channel_of(offset)];
    if (is_control(offset))
      command_counter(channel_of(offset), value);
    else if (counter.pointer < counter.preset.size())
      counter.preset[counter.pointer++] = value;
  } else if (offset == kPortC) {
    state_.output_latch[0] = value;
    drive_outputs();
  } else if (offset == port_d(state_.model)) {
    state_.output_latch[1] = value;
    drive_outputs();
  } else if (offset == kDirectionAbc || offset == kDirectionD) {
    (offset == kDirectionAbc ? state_.c_is_output : state_.d_is_output) =
        value == (offset == kDirectionAbc ? kAbInCOut : kDOut);
    state_.output_latch[offset == kDirectionAbc ? 0 : 1] = 0;  // a mode word clears the 8255's outputs
    drive_outputs();
  } else if (offset == kTimerCommand) {
    command_timer(value);
  } else if (offset == kTimer1) {
    state_.timer_1_divisor = value;
  } else if (offset == kTimer0) {
    load_timer_0(value);
  }
}

void EmulatedServoToGo::out_16(std::uint16_t port, std::uint16_t value) noexcept {
  const auto offset = static_cast<std::uint16_t>(port - base_);
  if (offset >= converter(0) && offset < converter(kChannels) && offset % 2 == 0) {
    connector_.set_converter((offset - converter(0)) / 2U, value & kConverterLargest);
    return;
  }
  out_8(port, static_cast<std::uint8_t>(value));
  out_8(static_cast<std::uint16_t>(port + 1), static_cast<std::uint8_t>(value >> 8U));
}

/// Bits 7 and 6: 0 command, 1 input control, 2 output control, 3 quadrature.
void EmulatedServoToGo::command_counter(std::size_t channel, std::uint8_t command) noexcept {
  auto& counter = state_.counters[channel];
  if (command >> 6U == 0) return act_on_counter(counter, channel, command);
  const auto kept = value(channel);  // a change of mode keeps the value
  if (command >> 6U == 1) counter.input_control = command;
  if (command >> 6U == 3) counter.quadrature = command;
  set_value(channel, kept);
}

void EmulatedServoToGo::act_on_counter(CardState::Counter& counter, std::size_t channel,
                                       std::uint8_t command) noexcept {
  if ((command & 0x20U) != 0) counter = {};
  if ((command & 0x04U) != 0) set_value(channel, 0);
  if ((command & 0x08U) != 0)
    set_value(channel, std::uint32_t{counter.preset[0]} | std::uint32_t{counter.preset[1]} << 8U |
                           std::uint32_t{counter.preset[2]} << 16U);
  if ((command & 0x02U) != 0) latch(channel);
  if ((command & 0x01U) != 0) counter.pointer = 0;
}

std::uint32_t EmulatedServoToGo::value(std::size_t channel) noexcept {
  const auto& counter = state_.counters[channel];
  if (!counts(counter)) return counter.origin_counts & k24Bits;
  return (static_cast<std::uint32_t>(connector_.pulses(channel)) - counter.origin_counts) & k24Bits;
}

void EmulatedServoToGo::set_value(std::size_t channel, std::uint32_t counts_24_bit) noexcept {
  auto& counter = state_.counters[channel];
  counter.origin_counts = counts(counter)
                              ? static_cast<std::uint32_t>(connector_.pulses(channel)) - counts_24_bit
                              : counts_24_bit;
}

void EmulatedServoToGo::latch(std::size_t channel) noexcept {
  if (connector_.latch_is_stuck()) return;
  const auto now = value(channel);
  auto& bytes = state_.counters[channel].latch;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(now >> (8U * i));
}

std::uint8_t EmulatedServoToGo::next_latched_byte(std::size_t channel) noexcept {
  auto& counter = state_.counters[channel];
  if (counter.pointer >= counter.latch.size()) counter.pointer = 0;
  return counter.latch[counter.pointer++];
}

std::uint8_t EmulatedServoToGo::board_test() noexcept {
  const unsigned serial = state_.model == 1 ? kSerialModel1 : kSerialModel2;
  const unsigned index = state_.board_test_index++ & 7U;
  return static_cast<std::uint8_t>(((serial >> index) & 1U) << 7U | index << 4U);
}

void EmulatedServoToGo::command_timer(std::uint8_t command) noexcept {
  if (command >> 6U != 0) return;  // the modes of timers 1 and 2, which divide the clock, have no effect here
  state_.timer_period_ns = 0;      // a mode word stops the timer until a count is written
  state_.timer_0_high_next = false;
  state_.timer_0_loadable = command == kTimer0Periodic;
}

void EmulatedServoToGo::load_timer_0(std::uint8_t value) noexcept {
  if (!state_.timer_0_loadable) return;
  state_.timer_0_high_next = !state_.timer_0_high_next;
  if (state_.timer_0_high_next) {
    state_.timer_0_low = value;
    return;
  }
  const unsigned count = unsigned{value} << 8U | state_.timer_0_low;
  state_.timer_period_ns = static_cast<std::int64_t>(count * state_.timer_1_divisor / kTimerClock_hz * 1e9);
  state_.timer_begin_ns = connector_.now_ns();
}

/// Ends the periods that have passed; the end of a period latches all counters.
void EmulatedServoToGo::let_time_pass() noexcept {
  if (state_.timer_period_ns == 0) return;
  const auto periods = (connector_.now_ns() - state_.timer_begin_ns) / state_.timer_period_ns;
  if (periods == 0) return;
  state_.timer_begin_ns += periods * state_.timer_period_ns;
  for (std::size_t channel = 0; channel < kChannels; ++channel) latch(channel);
}

void EmulatedServoToGo::drive_outputs() noexcept {
  const unsigned c = state_.c_is_output ? state_.output_latch[0] : 0U;
  const unsigned d = state_.d_is_output ? state_.output_latch[1] : 0U;
  connector_.set_outputs(static_cast<std::uint16_t>(d << 8U | c));
}

}  // namespace crane::bridge
