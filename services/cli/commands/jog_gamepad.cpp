/// A gamepad as the stick of `crane jog`.
#include <iostream>

#include "cli/gamepad.hpp"
#include "cli/gamepad_device.hpp"
#include "cli/jog_loop.hpp"
#include "jog.hpp"

namespace crane::cli {

int jog_by_gamepad(const std::string& device_path, const StickOptions& options) {
  GamepadDevice device{device_path.empty() ? find_gamepad() : std::filesystem::path{device_path},
                       options.selected};
  Gamepad gamepad{device.name(), [&device](std::vector<GamepadEvent>& events) { return device.read(events); },
                  GamepadLaw{device.ranges(), options.selected, options.micro}};
  auto bus = open_bus(options.bus, crane_SOURCE_OPERATOR);
  JogLoop loop{bus, gamepad, {options.selected, options.step_m, options.timeout_s}};
  std::cout
      << "gamepad " << device.name()
      << "\nhold the left shoulder button; left stick: trolley and slew, right stick: hoist,\n"
         "right shoulder button: micro-speed, lower action button: return to the stop point, Ctrl-C: end"
      << std::endl;
  return loop.run();
}

}  // namespace crane::cli
