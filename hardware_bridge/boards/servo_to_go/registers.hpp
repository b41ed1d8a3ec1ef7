#pragma once
/// Registers of the Servo-to-Go ISA card, models 1 and 2: 8 counters of 24 bit (LS7166), 8 converters of 13
/// bit, 32 digital lines (8255), interval timer (8254). Offsets from the base address 0x200 + 0x20 n; the
/// second window is at base + 0x400.
#include <array>
#include <cstddef>
#include <cstdint>

namespace crane::bridge::servo_to_go {

inline constexpr std::size_t kChannels = 8;
inline constexpr std::uint16_t kWindow = 0x20;
inline constexpr std::uint16_t kSecondWindow = 0x400;

/// Counters: 0 -> 0, 1 -> 1, 2 -> 4, 3 -> 5, ...; a 16-bit access at an even channel reaches two counters at
/// once.
[[nodiscard]] constexpr std::uint16_t counter_data(std::size_t channel) {
  return static_cast<std::uint16_t>(2 * channel - channel % 2);
}
[[nodiscard]] constexpr std::uint16_t counter_control(std::size_t channel) {
  return static_cast<std::uint16_t>(counter_data(channel) + 2);
}
/// Values for the control register of a counter. The two highest bits select the setting.
enum CounterCommand : std::uint8_t {
  kMasterReset = 0x20,
  kInputControl = 0x68,   ///< A and B enabled, load pin loads the output latch
  kOutputControl = 0x80,  ///< binary
  kQuadrature = 0xC3,     ///< four counts per line
  kZero = 0x04,
  kLatch = 0x03,   ///< counter to output latch, byte pointer to the first byte
  kRewind = 0x01,  ///< byte pointer to the first byte
  kPreset = 0x09   ///< the last three written bytes become the counter; byte pointer to the first byte
};

[[nodiscard]] constexpr std::uint16_t converter(std::size_t channel) {
  return static_cast<std::uint16_t>(0x10 + 2 * channel);
}

inline constexpr std::uint16_t kPortA = 0x400, kPortB = 0x402, kPortC = 0x404;
/// Port D by model.
[[nodiscard]] constexpr std::uint16_t port_d(int model) { return model == 1 ? 0x401 : 0x405; }
inline constexpr std::uint16_t kDirectionAbc = 0x406, kDirectionD = 0x407;
enum Direction : std::uint8_t {  // mode words of the 8255
  kAbInCOut = 0x92,
  kDOut = 0x82
};

/// Read eight times: the upper nibble is one bit of the serial number and the index of that bit.
inline constexpr std::uint16_t kBoardTest = 0x403;
inline constexpr std::uint8_t kSerialModel1 = 0x75, kSerialModel2 = 0x74;

inline constexpr std::uint16_t kTimer0 = 0x408, kTimer1 = 0x40A, kTimer2 = 0x40C, kTimerCommand = 0x40E;
enum TimerCommand : std::uint8_t {
  kTimer1Square = 0x56,   ///< timer 1 divides the clock
  kTimer1Divisor = 0xB4,  ///< 180: 25 us at 7.2 MHz
  kTimer0Periodic =
      0x34,  ///< timer 0: low and high byte of period / 25 us follow; each period latches all counters
  kTimerStop = 0x02,
  kTimer0NoCount = 0x30  ///< mode 0: the timer stops until a count is written
};

}  // namespace crane::bridge::servo_to_go
