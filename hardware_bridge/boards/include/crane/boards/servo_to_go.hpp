#pragma once
/// Driver of the Servo-to-Go ISA card, models 1 and 2 (docs/hardware.md describes registers and wiring).
///
/// Counters: all counters in use are latched within a few port accesses before the first byte is
/// read. The constructor presets the counters (start_counts()). Converters: see
/// crane/bridge/converter.hpp. Inputs: active low (normally closed contacts). Outputs: on is high.
#include <array>
#include <cstdint>
#include <memory>

#include "crane/boards/port_io.hpp"
#include "crane/boards/rig_lines.hpp"
#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

class ServoToGo final : public Board {
 public:
  /// Recognises the card before the first write, makes it safe, and starts the counters.
  /// @throws BoardError when there is no card at the base address, or a counter does not keep a written value
  ServoToGo(const configuration::Rig& rig, std::unique_ptr<PortIo> ports);
  /// Leaves the card at 0 V with all outputs off.
  ~ServoToGo() override;
  ServoToGo(const ServoToGo&) = delete;
  ServoToGo& operator=(const ServoToGo&) = delete;

  [[nodiscard]] std::string_view name() const override;
  /// @throws BoardError when the card does not answer: it was removed or lost its power
  [[nodiscard]] Inputs read() override;
  std::array<double, kDrives> write(const Outputs& outputs) override;
  void make_safe() noexcept override;
  void advance_to(std::int64_t /*time_ns*/) override {}
  [[nodiscard]] int model() const { return model_; }

 private:
  struct Counter {
    bool used = false;
    std::size_t channel = 0;
    std::int64_t start_counts = 0;
  };
  [[nodiscard]] std::uint16_t at(std::uint16_t offset) const {
    return static_cast<std::uint16_t>(base_ + offset);
  }
  [[nodiscard]] int recognised_model() const;
  void check_presence() const;
  void stop_timer() noexcept;
  void start_counter(const Counter& counter);
  /// Writes the low 24 bits of `counts`.
  void preset(std::size_t channel, std::int64_t counts) noexcept;
  void latch_all() noexcept;
  [[nodiscard]] std::int32_t latched(std::size_t channel) noexcept;
  [[nodiscard]] std::uint16_t input_levels() noexcept;
  void set_outputs(std::uint32_t levels) noexcept;

  std::unique_ptr<PortIo> ports_;
  std::uint16_t base_;
  RigLines lines_;
  std::array<std::size_t, kDrives> converter_channel_{};
  std::array<Counter, kCounters> counters_{};
  std::array<bool, 4> pair_used_{};  ///< by channel / 2
  int model_;
};

}  // namespace crane::bridge
