#pragma once
/// An operator at a stick: sessions while the stick is deflected, inching and returns between them.
#include <optional>

#include "cli/jog_moves.hpp"
#include "cli/jog_session.hpp"
#include "cli/operator_stick.hpp"

namespace crane::cli {

struct JogLoopOptions {
  std::array<bool, 3> selected{};  ///< axes of a session and of inching
  double step_m = kInchingStep_m;
  double timeout_s = 60;  ///< longest wait for rest
};

class JogLoop {
 public:
  /// @param bus    of an operator. @param stick  must outlive the loop
  JogLoop(bus::Bus& bus, OperatorStick& stick, const JogLoopOptions& options);

  /// Until the operator ends the program, or a session is refused. @return exit code
  /// @throws std::runtime_error, NoAnswer: the crane has stopped, or the stick cannot be used any more
  int run();

 private:
  /// One session. @return false: refused
  bool drive();
  /// Positions at which the operator has released the stick: all axes when the last axis is released.
  void note_release(const std::optional<Deflection>& stick);
  void inch(const InchingStep& step);
  void go_back();
  bool execute(const char* what, const AxisTargets& targets);
  void read();

  bus::Bus& bus_;
  OperatorStick& stick_;
  JogLoopOptions options_;
  JogSession session_;
  JogMoves moves_;
  bool deflected_ = false;
  std::optional<std::array<double, 3>> stop_point_;  ///< m, rad, m of cable
};

}  // namespace crane::cli
