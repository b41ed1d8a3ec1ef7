#pragma once
/// What an operator holds: keyboard or gamepad. Time is an argument.
#include <array>
#include <optional>
#include <string>

#include "cli/inching.hpp"

namespace crane::cli {

class OperatorStick {
 public:
  OperatorStick() = default;
  virtual ~OperatorStick() = default;
  OperatorStick(const OperatorStick&) = delete;
  OperatorStick& operator=(const OperatorStick&) = delete;

  /// Takes the input that has arrived. Does not wait.
  virtual void read(double now_s) = 0;
  /// Deflection of trolley, slew and hoist in [-1, 1]; nothing: the operator does not hold the stick.
  [[nodiscard]] virtual std::optional<std::array<double, 3>> deflection(double now_s) const = 0;
  /// Step of inching, once.
  virtual std::optional<InchingStep> take_step() = 0;
  /// True once when the operator asks for the return to the stop point.
  virtual bool take_return() = 0;
  /// True once when the operator stops a move.
  virtual bool take_release() = 0;
  /// True: the operator ends the program.
  [[nodiscard]] virtual bool quits() const = 0;
  /// Why the stick cannot be used any more, with the remedy; empty: it can.
  [[nodiscard]] virtual const std::string& problem() const = 0;
};

}  // namespace crane::cli
