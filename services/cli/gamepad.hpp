#pragma once
/// A gamepad as the stick of an operator: reads the events of a device and gives them to GamepadLaw.
#include <functional>
#include <string>
#include <vector>

#include "cli/gamepad_law.hpp"
#include "cli/operator_stick.hpp"

namespace crane::cli {

/// Appends the events that have arrived. @return 0, or errno when the device cannot be read any more
using GamepadReader = std::function<int(std::vector<GamepadEvent>&)>;

class Gamepad : public OperatorStick {
 public:
  /// @param name  name of the device in messages
  Gamepad(std::string name, GamepadReader reader, const GamepadLaw& law);

  void read(double now_s) override;
  [[nodiscard]] std::optional<std::array<double, 3>> deflection(double now_s) const override;
  std::optional<InchingStep> take_step() override { return std::nullopt; }
  bool take_return() override { return law_.take_return(); }
  /// True while the dead-man's button is released: the operator then stops a move.
  bool take_stop() override { return !law_.dead_man_pressed(); }
  [[nodiscard]] bool quits() const override { return false; }
  [[nodiscard]] const std::string& problem() const override { return problem_; }

 private:
  std::string name_;
  GamepadReader reader_;
  GamepadLaw law_;
  std::vector<GamepadEvent> events_;
  std::string problem_;
  bool centre_requested_ = false;
};

}  // namespace crane::cli
