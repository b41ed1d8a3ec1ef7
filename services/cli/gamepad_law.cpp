#include "cli/gamepad_law.hpp"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/inching.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::cli {
namespace {

constexpr std::array<std::uint16_t, 3> kCodes{ABS_Y, ABS_X, ABS_RY};
constexpr std::array<const char*, 3> kNames{"ABS_Y", "ABS_X", "ABS_RY"};
constexpr std::array<double, 3> kSigns{-1, 1, 1};  // counts increase to the right and towards the operator

double half_range(const StickRange& range) {
  return (static_cast<double>(range.maximum) - static_cast<double>(range.minimum)) / 2;
}

/// Dead zone as a share of half the range.
double dead_zone(const StickRange& range) {
  return std::max(GamepadLaw::kDeadZone, static_cast<double>(range.flat) / half_range(range));
}

/// y = sign(x) (|x| - d) / (1 - d) for |x| > d, otherwise 0; x in [-1, 1], dead zone d. y has no jump at d.
double share_of(const StickRange& range) {
  const double centre = range.minimum + half_range(range);
  const double x = (range.value - centre) / half_range(range);
  const double beyond = (std::abs(x) - dead_zone(range)) / (1 - dead_zone(range));
  return std::copysign(std::clamp(beyond, 0.0, 1.0), x);
}

}  // namespace

std::uint16_t stick_code(std::size_t axis) { return kCodes.at(axis); }

std::string problem_of(const StickRanges& ranges, const std::array<bool, 3>& selected) {
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (!selected[i]) continue;
    const auto& range = ranges[i];
    const auto name = std::string{kNames[i]} + " (" + std::string{plant::kCoordinates[i].name} + ")";
    if (!range.present) return "it has no axis " + name;
    if (range.minimum >= range.maximum)
      return "its axis " + name + " has no range: minimum " + std::to_string(range.minimum) + ", maximum " +
             std::to_string(range.maximum);
    if (range.flat < 0 || dead_zone(range) >= 1)
      return "the dead zone (flat = " + std::to_string(range.flat) + ") of its axis " + name +
             " covers the whole range";
  }
  return "";
}

GamepadLaw::GamepadLaw(const StickRanges& ranges, const std::array<bool, 3>& selected, bool micro)
    : ranges_{ranges}, selected_{selected}, micro_{micro} {}

bool GamepadLaw::take_button(std::uint16_t code, int value) {
  constexpr int kReleased = 0, kPressed = 1;  // 2: repetition by the kernel
  if (value != kReleased && value != kPressed) return false;
  const bool pressed = value == kPressed;
  if (code == BTN_TL) {
    dead_man_pressed_ = pressed;
    centred_ = false;
    returns_ = returns_ && dead_man_pressed_;
  } else if (code == BTN_TR) {
    micro_pressed_ = pressed;
  } else if (code == BTN_SOUTH && pressed && dead_man_pressed_) {
    returns_ = true;
  } else {
    return false;
  }
  return true;
}

bool GamepadLaw::take_stick(std::uint16_t code, int value) {
  for (std::size_t i = 0; i < ranges_.size(); ++i)
    if (kCodes[i] == code) return std::exchange(ranges_[i].value, value) != value && selected_[i];
  return false;
}

void GamepadLaw::take(const GamepadEvent& event, double now_s) {
  if (silent(now_s)) dead_man_pressed_ = centred_ = returns_ = false;
  if ((event.type == EV_KEY && take_button(event.code, event.value)) ||
      (event.type == EV_ABS && take_stick(event.code, event.value)))
    last_event_s_ = now_s;
  const auto now = deflection();
  if (dead_man_pressed_ && std::ranges::all_of(now, [](double share) { return share == 0; })) centred_ = true;
}

bool GamepadLaw::engaged(double now_s) const {
  return dead_man_pressed_ && centred_ && !returns_ && !silent(now_s);
}

std::array<double, 3> GamepadLaw::deflection() const {
  std::array<double, 3> result{};
  const double scale = micro_ || micro_pressed_ ? kMicroSpeed : 1;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double share = selected_[i] ? share_of(ranges_[i]) : 0;
    result[i] = share == 0 ? 0 : kSigns[i] * scale * share;
  }
  return result;
}

bool GamepadLaw::take_return() { return std::exchange(returns_, false); }

}  // namespace crane::cli
