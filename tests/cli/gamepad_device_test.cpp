/// Reading a gamepad: devices that cannot be used, and virtual devices (uinput) where the kernel permits
/// them.
#include "cli/gamepad_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <optional>

#include "cli/gamepad.hpp"
#include "temporary_directory.hpp"

namespace crane::cli {
namespace {

using testing::HasSubstr, testing::ThrowsMessage;
constexpr std::array kAllAxes{true, true, true};

void open_device(const std::filesystem::path& path) { const GamepadDevice device{path, kAllAxes}; }

TEST(GamepadDevice, ThatIsMissingIsNamedWithTheRemedy) {
  EXPECT_THAT([] { open_device("/dev/input/no_such_event"); },
              ThrowsMessage<GamepadError>(AllOf(HasSubstr("/dev/input/no_such_event"), HasSubstr("plug"))));
}

TEST(GamepadDevice, ThatIsNotAnInputDeviceIsNamed) {
  EXPECT_THAT([] { open_device("/dev/null"); },
              ThrowsMessage<GamepadError>(AllOf(HasSubstr("/dev/null"), HasSubstr("not an input device"))));
}

TEST(GamepadDevice, IsNotFoundInAnEmptyDirectory) {
  const recording::TemporaryDirectory empty;
  EXPECT_THAT([&] { (void)find_gamepad(empty / "."); }, ThrowsMessage<GamepadError>(HasSubstr("none found")));
  EXPECT_THAT([] { (void)find_gamepad("/no/such/directory"); },
              ThrowsMessage<GamepadError>(HasSubstr("none found")));
}

TEST(GamepadStick, ThatIsUnpluggedIsReleasedWithTheRemedy) {
  int error = 0;
  std::vector<GamepadEvent> arrive{{EV_KEY, BTN_TL, 1}};
  Gamepad gamepad{"/dev/input/event5 (Pad)",
                  [&](std::vector<GamepadEvent>& events) {
                    events = arrive;
                    return error;
                  },
                  GamepadLaw{StickRanges{}, kAllAxes}};
  gamepad.read(1);
  arrive = {{EV_ABS, ABS_X, 32767}};
  gamepad.read(1.1);
  ASSERT_NE(gamepad.deflection(1.1), std::nullopt);
  error = ENODEV;
  gamepad.read(1.2);
  EXPECT_EQ(gamepad.deflection(1.2), std::nullopt);
  EXPECT_THAT(gamepad.problem(),
              AllOf(HasSubstr("event5 (Pad)"), HasSubstr("unplugged"), HasSubstr("again")));
  error = 0;
  gamepad.read(1.3);
  EXPECT_NE(gamepad.problem(), "") << "a device that comes back does not act";
}

/// Virtual gamepad of the kernel (uinput).
class VirtualGamepad {
 public:
  explicit VirtualGamepad(int highest = 32767) : description_{libevdev_new()} {
    libevdev_set_name(description_, "crane test gamepad");
    for (const unsigned code : {BTN_TL, BTN_TR, BTN_SOUTH})
      libevdev_enable_event_code(description_, EV_KEY, code, nullptr);
    for (const unsigned code : {ABS_X, ABS_Y, ABS_RY}) {
      input_absinfo range{};
      range.minimum = -highest;
      range.maximum = highest;
      libevdev_enable_event_code(description_, EV_ABS, code, &range);
    }
    error_ = libevdev_uinput_create_from_device(description_, LIBEVDEV_UINPUT_OPEN_MANAGED, &device_);
  }
  ~VirtualGamepad() {
    unplug();
    libevdev_free(description_);
  }
  VirtualGamepad(const VirtualGamepad&) = delete;
  VirtualGamepad& operator=(const VirtualGamepad&) = delete;

  [[nodiscard]] int error() const { return -error_; }
  [[nodiscard]] std::string path() const { return libevdev_uinput_get_devnode(device_); }
  void send(unsigned type, unsigned code, int value) const {
    libevdev_uinput_write_event(device_, type, code, value);
    libevdev_uinput_write_event(device_, EV_SYN, SYN_REPORT, 0);
  }
  void unplug() {
    if (device_ != nullptr) libevdev_uinput_destroy(device_);
    device_ = nullptr;
  }

 private:
  libevdev* description_;
  libevdev_uinput* device_ = nullptr;
  int error_ = 0;
};

/// Waits until udev has set the permissions of a new device. @return false after 5 s
bool wait_until_readable(const std::string& path) {
  constexpr int kPatience_ms = 5000;
  const int changes = ::inotify_init1(IN_CLOEXEC);
  ::inotify_add_watch(changes, path.c_str(), IN_ATTRIB);
  pollfd event{changes, POLLIN, 0};
  bool readable = ::access(path.c_str(), R_OK) == 0;
  while (!readable && ::poll(&event, 1, kPatience_ms) > 0) {
    std::array<char, 4096> ignored{};
    if (::read(changes, ignored.data(), ignored.size()) < 0) break;
    readable = ::access(path.c_str(), R_OK) == 0;
  }
  ::close(changes);
  return readable;
}

TEST(GamepadDevice, OfTheKernelReportsItsEventsAndItsEnd) {
  VirtualGamepad pad;
  if (pad.error() != 0)
    GTEST_SKIP() << "no virtual gamepad: /dev/uinput: " << std::generic_category().message(pad.error());
  ASSERT_TRUE(wait_until_readable(pad.path()));
  GamepadDevice device{pad.path(), kAllAxes};
  EXPECT_THAT([&] { open_device(pad.path()); }, ThrowsMessage<GamepadError>(HasSubstr("another program")));
  pad.send(EV_KEY, BTN_TL, 1);
  pad.send(EV_ABS, ABS_X, 32767);  // the kernel queues the events for all readers before it returns
  GamepadLaw law{device.ranges(), kAllAxes};
  std::vector<GamepadEvent> events;
  ASSERT_EQ(device.read(events), 0);
  for (const auto& event : events) law.take(event, 1);
  EXPECT_TRUE(law.engaged(1));
  EXPECT_EQ(law.deflection()[1], 1);
  pad.unplug();
  EXPECT_EQ(device.read(events), ENODEV);
}

TEST(GamepadDevice, OfTheKernelWithoutRangeIsNamed) {
  VirtualGamepad pad{0};
  if (pad.error() != 0)
    GTEST_SKIP() << "no virtual gamepad: /dev/uinput: " << std::generic_category().message(pad.error());
  ASSERT_TRUE(wait_until_readable(pad.path()));
  EXPECT_THAT([&] { open_device(pad.path()); }, ThrowsMessage<GamepadError>(HasSubstr("has no range")));
}

}  // namespace
}  // namespace crane::cli
