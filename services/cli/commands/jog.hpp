#pragma once
/// Operation of the stick of `crane jog` with a keyboard or a gamepad.
#include <array>
#include <string>

#include "cli/inching.hpp"
#include "cli/tool_bus.hpp"

namespace crane::cli {

struct StickOptions {
  std::array<bool, 3> selected{};  ///< axes of a session and of inching
  bool micro = false;              ///< micro-speed at the start
  bool inching = false;            ///< inching at the start
  double step_m = kInchingStep_m;  ///< step of inching
  double timeout_s = 60;           ///< longest wait for rest
  runtime::BusOptions bus = tool_bus();
};

/// Operates the stick with the keys of the terminal until q. @return exit code
/// @throws std::runtime_error when standard input is not a terminal, or when the crane has stopped
int jog_by_keyboard(const StickOptions& options);

/// Operates the stick with a gamepad until Ctrl-C. @param device_path  empty: the only gamepad in /dev/input
/// @return exit code
/// @throws GamepadError when the gamepad cannot be used
/// @throws std::runtime_error when the gamepad was unplugged, or when the crane has stopped
int jog_by_gamepad(const std::string& device_path, const StickOptions& options);

}  // namespace crane::cli
