#pragma once
/// What is being done when a fault strikes: rig, controller and move, chosen by the seed, and the moment.
#include <optional>
#include <string_view>

#include "crane/configuration/rig.hpp"
#include "crane/control/law.hpp"

namespace crane::campaign {

/// The six moments of docs/safety.md.
enum class Moment : std::uint8_t {
  armed_idle,         ///< HOLD, nothing asked for
  brake_release,      ///< the tick in which the brakes are told to open
  peak_acceleration,  ///< RUN: the axis gains speed
  cruise,             ///< RUN: the axis has reached its largest speed
  limit,              ///< RUN: the axis brakes before the end of its permitted travel
  stop                ///< the operator's stop is being executed
};
inline constexpr std::size_t kMoments = 6;
[[nodiscard]] std::string_view name_of(Moment moment) noexcept;
/// @return nothing when there is none of that name
[[nodiscard]] std::optional<Moment> moment_named(std::string_view name) noexcept;

struct Setting {
  configuration::Rig told;   ///< what the rig file says: components are built from it
  configuration::Rig wired;  ///< the rig as it is
  const control::Controller* controller = nullptr;
  std::array<bool, 3> selected{};  ///< axes that move
  std::array<double, 3> target{};  ///< m, rad, m of cable
  std::size_t axis = 0;            ///< the axis that the fault concerns
};

inline constexpr std::uint64_t kSettings = 12;
/// @param number  < kSettings
[[nodiscard]] Setting setting(std::uint64_t number, Moment moment);

}  // namespace crane::campaign
