#pragma once
/// Emulation of the registers of a Servo-to-Go card. A driver accesses the emulated card through PortIo, like
/// a real card. A Connector represents the wiring of the card.
///
/// Modelled: counters with output latch, byte pointer, preset, input enable and quadrature mode (8- and
/// 16-bit accesses); converters; 8255 ports with directions; board test; 8254 timer 0 behind timer 1, which
/// latches all counters in each period.
/// Not modelled: ADC, index pulses, interrupts. Reading any other port returns 0xFF. Counters follow `pulses`
/// modulo 2^24 while their inputs are enabled.
#include <array>
#include <cstdint>
#include <memory>

#include "crane/boards/port_io.hpp"

namespace crane::bridge {

inline constexpr std::size_t kCardChannels = 8;

/// Connectors of the card.
class Connector {
 public:
  virtual ~Connector() = default;
  /// Quadrature edges of an encoder since power-on; may wrap at 2^32.
  [[nodiscard]] virtual std::int32_t pulses(std::size_t channel) noexcept = 0;
  /// Levels of the 16 lines of ports A and B.
  [[nodiscard]] virtual std::uint16_t inputs() noexcept = 0;
  virtual void set_converter(std::size_t channel, std::uint16_t code) noexcept = 0;
  /// Sets the levels of the 16 lines of ports C and D; a line that is not an output is low.
  virtual void set_outputs(std::uint16_t levels) noexcept = 0;
  /// Time of the rig.
  [[nodiscard]] virtual std::int64_t now_ns() noexcept = 0;
  /// True: a fault of the card; the output latches of the counters keep their value.
  [[nodiscard]] virtual bool latch_is_stuck() noexcept { return false; }
};

/// State of the card. Plain data: in shared memory, the state survives the process of the driver.
struct CardState {
  struct Counter {
    std::uint32_t origin_counts = 0;  ///< inputs enabled: value of the counter = pulses - origin_counts;
                                      ///< inputs disabled: value of the counter
    std::array<std::uint8_t, 3> latch{}, preset{};
    std::uint8_t pointer = 0;
    std::uint8_t input_control = 0, quadrature = 0;
  };
  int model = 1;
  std::array<Counter, kCardChannels> counters{};
  std::array<std::uint8_t, 2> output_latch{};  ///< ports C and D
  bool c_is_output = false, d_is_output = false;
  std::uint8_t board_test_index = 0;
  std::uint8_t timer_1_divisor = 0;
  std::uint8_t timer_0_low = 0;
  bool timer_0_high_next = false, timer_0_loadable = false;
  std::int64_t timer_period_ns = 0;  ///< 0: stopped
  std::int64_t timer_begin_ns = 0;   ///< start of the present period
};

class EmulatedServoToGo final : public PortIo {
 public:
  /// `state` and `connector` must outlive this object.
  EmulatedServoToGo(std::uint16_t base_address, CardState& state, Connector& connector)
      : base_{base_address}, state_{state}, connector_{connector} {}

  [[nodiscard]] std::uint8_t in_8(std::uint16_t port) noexcept override;
  [[nodiscard]] std::uint16_t in_16(std::uint16_t port) noexcept override;
  void out_8(std::uint16_t port, std::uint8_t value) noexcept override;
  void out_16(std::uint16_t port, std::uint16_t value) noexcept override;

 private:
  void command_counter(std::size_t channel, std::uint8_t command) noexcept;
  void act_on_counter(CardState::Counter& counter, std::size_t channel, std::uint8_t command) noexcept;
  [[nodiscard]] std::uint32_t value(std::size_t channel) noexcept;
  void set_value(std::size_t channel, std::uint32_t counts) noexcept;
  void latch(std::size_t channel) noexcept;
  [[nodiscard]] std::uint8_t next_latched_byte(std::size_t channel) noexcept;
  [[nodiscard]] std::uint8_t board_test() noexcept;
  void command_timer(std::uint8_t command) noexcept;
  void load_timer_0(std::uint8_t value) noexcept;
  void let_time_pass() noexcept;
  void drive_outputs() noexcept;

  std::uint16_t base_;
  CardState& state_;
  Connector& connector_;
};

}  // namespace crane::bridge
