#pragma once
/// A gamepad of the Linux input system (evdev), read with libevdev.
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/gamepad_law.hpp"

struct libevdev;

namespace crane::cli {

/// The device cannot be used. what() names the device, the cause and the remedy.
class GamepadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class GamepadDevice {
 public:
  /// Opens the device and reserves it: no other program receives its events.
  /// @param selected  axes of the session; the device must have a stick for each
  /// @throws GamepadError
  GamepadDevice(const std::filesystem::path& path, const std::array<bool, 3>& selected);
  ~GamepadDevice();
  GamepadDevice(const GamepadDevice&) = delete;
  GamepadDevice& operator=(const GamepadDevice&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const StickRanges& ranges() const { return ranges_; }
  /// Appends the events that have arrived. After a loss of events (SYN_DROPPED), appends the events with
  /// which libevdev restores the present values. Does not wait.
  /// @return 0, or errno when the device cannot be read any more (ENODEV: unplugged)
  int read(std::vector<GamepadEvent>& events);

 private:
  void check(const std::filesystem::path& path, const std::array<bool, 3>& selected);

  int file_ = -1;
  libevdev* device_ = nullptr;
  std::string name_;
  StickRanges ranges_{};
};

/// @return path of the only device in `directory` that has BTN_TL and ABS_X
/// @throws GamepadError when no device has them, or several have them; what() lists these devices
[[nodiscard]] std::filesystem::path find_gamepad(const std::filesystem::path& directory = "/dev/input");

}  // namespace crane::cli
