#pragma once
/// The boards of the conformance tests, each with its crane.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "crane/boards/emulated_board.hpp"
#include "crane/emulated_rig/wired_rig.hpp"
#include "crane/simulator/component.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::bridge::test {

using emulated_rig::WiredRig;

inline constexpr std::int64_t kTick_ns = 10'000'000;

/// The rig of deploy/rigs/emulated_servo_to_go.toml.
inline configuration::Rig emulated_rig() {
  return configuration::load_rig(CRANE_RIGS "/emulated_servo_to_go.toml");
}

inline constexpr std::array<double, kDrives> kNothing{};

/// One board with its crane, observed from outside.
class Subject {
 public:
  virtual ~Subject() = default;
  [[nodiscard]] virtual Board& board() = 0;
  [[nodiscard]] virtual simulator::SimulatedBoard& crane() = 0;
  /// Volts at the amplifiers.
  [[nodiscard]] virtual std::array<double, kDrives> amplifier_v() = 0;
  /// Ends the program of the board as at a normal exit; the crane continues.
  virtual void close() = 0;
  virtual void pass(std::int64_t duration_ns) = 0;

  /// Writes outputs for several ticks and toggles the watchdog output in each tick.
  std::array<double, kDrives> tick(const std::array<double, kDrives>& drive_v, bool release, int ticks = 1) {
    std::array<double, kDrives> given{};
    for (int i = 0; i < ticks; ++i) {
      outputs_ = {drive_v, {release, release, release}, !outputs_.watchdog_level};
      given = board().write(outputs_);
      pass(kTick_ns);
    }
    return given;
  }
  void open_brakes() { tick({}, true, 12); }
  [[nodiscard]] bool braked() {
    const auto inputs = crane().read();
    return inputs.brake_closed == std::array<bool, kDrives>{true, true, true};
  }

 private:
  Outputs outputs_;
};

class SimulatedSubject final : public Subject {
 public:
  explicit SimulatedSubject(const configuration::Rig& rig) : board_{simulator::simulated_rig_of(rig)} {}
  Board& board() override { return board_; }
  simulator::SimulatedBoard& crane() override { return board_; }
  std::array<double, kDrives> amplifier_v() override { return board_.converter_v(); }
  void close() override { board_.make_safe(); }  // not destroyed, because the board contains the crane
  void pass(std::int64_t duration_ns) override { board_.advance_to(board_.now_ns() + duration_ns); }

 private:
  simulator::SimulatedBoard board_;
};

/// The driver on an emulated card.
class CardSubject final : public Subject {
 public:
  CardSubject(const configuration::Rig& rig, int model) {
    auto crane = std::make_unique<WiredRig>(rig);
    crane->card().model = model;
    rig_ = crane.get();
    kept_ = std::move(crane);
    board_ = std::make_unique<ServoToGo>(
        rig, std::make_unique<EmulatedServoToGo>(static_cast<std::uint16_t>(rig.wiring.base_address),
                                                 rig_->card(), *rig_));
  }
  Board& board() override { return *board_; }
  simulator::SimulatedBoard& crane() override { return rig_->crane(); }
  std::array<double, kDrives> amplifier_v() override { return rig_->drive_v(); }
  void close() override { board_.reset(); }
  void pass(std::int64_t duration_ns) override { rig_->advance_to(rig_->now_ns() + duration_ns); }

 private:
  std::unique_ptr<WiredRig> kept_;
  WiredRig* rig_;
  std::unique_ptr<ServoToGo> board_;
};

/// A board of the conformance tests.
struct Kind {
  const char* name;
  std::vector<const char*> covers;  ///< names in rig files of boards with this driver
  std::function<std::unique_ptr<Subject>(const configuration::Rig&)> make;
  friend std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }
};

/// Every subject, in alphabetical order.
std::vector<Kind> all_boards();

/// Adds a subject: subjects/ has one file per driver.
struct RegisteredSubject {
  explicit RegisteredSubject(Kind kind);
};

}  // namespace crane::bridge::test
