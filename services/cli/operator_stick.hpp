#pragma once
/// Interface of keyboard and gamepad as the stick of an operator. Time is an argument.
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
  /// Deflection of trolley, slew and hoist in [-1, 1]; nothing while the stick is released.
  [[nodiscard]] virtual std::optional<std::array<double, 3>> deflection(double now_s) const = 0;
  /// Step of inching that the operator has requested since the last call.
  virtual std::optional<InchingStep> take_step() = 0;
  /// True once after each request for the return to the stop point.
  virtual bool take_return() = 0;
  /// True when the operator stops a move: once after each press of the space bar, or while the dead-man's
  /// button is released.
  virtual bool take_stop() = 0;
  /// True when the operator ends the program.
  [[nodiscard]] virtual bool quits() const = 0;
  /// Reason for which the stick cannot be used any more, with the remedy; empty while it can be used.
  [[nodiscard]] virtual const std::string& problem() const = 0;
};

}  // namespace crane::cli
