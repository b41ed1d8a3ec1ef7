#pragma once
/// Loop of the interactive `crane jog`: runs a session while the stick is deflected, and steps of inching and
/// returns between sessions.
#include <optional>

#include "cli/jog_moves.hpp"
#include "cli/operator_stick.hpp"
#include "cli/stick_session.hpp"

namespace crane::cli {

struct JogLoopOptions {
  std::array<bool, 3> selected{};  ///< axes of a session and of inching
  double step_m = kInchingStep_m;
  double timeout_s = 60;  ///< longest wait for rest
};

class JogLoop {
 public:
  /// @param bus    bus of an operator; must outlive the loop
  /// @param stick  must outlive the loop
  JogLoop(bus::Bus& bus, OperatorStick& stick, const JogLoopOptions& options);

  /// Runs until the operator ends the program, or until the supervisor refuses a session. @return exit code
  /// @throws std::runtime_error, NoAnswer: the crane has stopped, or the stick cannot be used any more
  int run();

 private:
  /// Drives one session. @return false when the supervisor refused it
  bool drive();
  /// Stores the stop point when the stick was deflected and no axis is deflected any more.
  void note_release(const std::optional<Deflection>& stick);
  void inch(const InchingStep& step);
  void go_back();
  /// Executes a move, which the operator can stop. @return false when the supervisor refused it
  bool execute(const char* what, const AxisTargets& targets);
  void read();

  bus::Bus& bus_;
  OperatorStick& stick_;
  JogLoopOptions options_;
  StickSession session_;
  JogMoves moves_;
  bool deflected_ = false;  ///< at the last call of note_release()
  /// The last session has ended although the stick was deflected: the supervisor has ended it because of a
  /// silent, late or stuck stick. A deflection acts again after a release only.
  bool must_release_ = false;
  std::optional<std::array<double, 3>> stop_point_;  ///< m, rad, m of cable
};

}  // namespace crane::cli
