#include "cli/gamepad.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "cli/terminal.hpp"

namespace crane::cli {

Gamepad::Gamepad(std::string name, GamepadReader reader, const GamepadLaw& law)
    : name_{std::move(name)}, reader_{std::move(reader)}, law_{law} {}

void Gamepad::read(double now_s) {
  if (!problem_.empty()) return;
  events_.clear();
  const int error = reader_(events_);
  for (const auto& event : events_) law_.take(event, now_s);
  if (law_.waits_for_centre() && !centre_requested_)
    print_unless_blocked(STDERR_FILENO,
                         "gamepad: let go of the sticks: they act after they have been in the centre\n");
  centre_requested_ = law_.waits_for_centre();
  if (error == ENODEV)
    problem_ = "the gamepad " + name_ +
               " was unplugged: the stick is released; plug it in again and start "
               "the command again";
  else if (error != 0)
    problem_ = "the gamepad " + name_ + " cannot be read (" + std::generic_category().message(error) +
               "): the stick is released; check its connection and start the command again";
}

std::optional<std::array<double, 3>> Gamepad::deflection(double now_s) const {
  if (!problem_.empty() || !law_.engaged(now_s)) return std::nullopt;
  return law_.deflection();
}

}  // namespace crane::cli
