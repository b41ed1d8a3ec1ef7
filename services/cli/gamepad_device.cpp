#include "cli/gamepad_device.hpp"

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "crane/fields/printable.hpp"

namespace crane::cli {
namespace {

std::string reason_of(int error, const std::string& path) {
  const auto message = std::generic_category().message(error);
  if (error == EACCES)
    return message + ": add the user to the group that owns it (`ls -l " + path + "`, usually input)";
  if (error == ENOENT || error == ENODEV) return message + ": plug the gamepad in, and look at /dev/input";
  return message;
}

bool is_gamepad(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  libevdev* device = nullptr;
  const bool known = libevdev_new_from_fd(file, &device) == 0;
  const bool found = known && libevdev_has_event_code(device, EV_KEY, BTN_TL) != 0 &&
                     libevdev_has_event_code(device, EV_ABS, ABS_X) != 0;
  libevdev_free(device);
  ::close(file);
  return found;
}

}  // namespace

GamepadDevice::GamepadDevice(const std::filesystem::path& path, const std::array<bool, 3>& selected)
    : file_{::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)} {
  try {
    check(path, selected);
  } catch (...) {
    libevdev_free(device_);
    if (file_ >= 0) ::close(file_);
    throw;
  }
}

GamepadDevice::~GamepadDevice() {
  libevdev_free(device_);
  ::close(file_);
}

void GamepadDevice::check(const std::filesystem::path& path, const std::array<bool, 3>& selected) {
  const auto text = path.string();
  if (file_ < 0) throw GamepadError("gamepad " + text + ": " + reason_of(errno, text));
  if (libevdev_new_from_fd(file_, &device_) != 0)
    throw GamepadError("gamepad " + text + ": not an input device: give one of /dev/input/event*");
  const char* name = libevdev_get_name(device_);
  name_ = text + " (" + fields::printable(name != nullptr ? name : "") + ")";
  const std::string other = "; use another gamepad";
  if (libevdev_has_event_code(device_, EV_KEY, BTN_TL) == 0)
    throw GamepadError("gamepad " + name_ + ": it has no button BTN_TL for the dead-man's switch" + other);
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const auto* found = libevdev_get_abs_info(device_, stick_code(i));
    ranges_[i] = found == nullptr
                     ? StickRange{.present = false}
                     : StickRange{true, found->minimum, found->maximum, found->flat, found->value};
  }
  if (const auto problem = problem_of(ranges_, selected); !problem.empty())
    throw GamepadError("gamepad " + name_ + ": " + problem + other);
  if (const int error = libevdev_grab(device_, LIBEVDEV_GRAB); error != 0)
    throw GamepadError("gamepad " + name_ + ": " + std::generic_category().message(-error) +
                       ": another program has reserved it: end that program");
}

int GamepadDevice::read(std::vector<GamepadEvent>& events) {
  constexpr int kMost = 4096;  // a device that sends endlessly must not block the loop
  unsigned flags = LIBEVDEV_READ_FLAG_NORMAL;
  for (int i = 0; i < kMost; ++i) {
    input_event event{};
    const int status = libevdev_next_event(device_, flags, &event);
    if (status == -EAGAIN) {
      if (flags == LIBEVDEV_READ_FLAG_NORMAL) return 0;
      flags = LIBEVDEV_READ_FLAG_NORMAL;  // libevdev has restored the present values
      continue;
    }
    if (status < 0) return -status;
    if (status == LIBEVDEV_READ_STATUS_SYNC) flags = LIBEVDEV_READ_FLAG_SYNC;
    events.push_back({event.type, event.code, event.value});
  }
  return 0;
}

std::filesystem::path find_gamepad(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> found;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator{directory, missing})
    if (entry.path().filename().string().starts_with("event") && is_gamepad(entry.path()))
      found.push_back(entry.path());
  std::ranges::sort(found);
  if (found.size() == 1) return found.front();
  if (found.empty())
    throw GamepadError(
        "gamepad: none found in " + directory.string() +
        " that this user may read: plug one in, or give its device: --gamepad /dev/input/event5");
  std::string names;
  for (const auto& path : found) names += (names.empty() ? "" : ", ") + path.string();
  throw GamepadError("gamepad: several found: " + names + ": give one with --gamepad");
}

}  // namespace crane::cli
