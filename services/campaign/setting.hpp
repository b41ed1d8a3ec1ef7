#pragma once
/// Situation of the crane when a fault is injected. The seed selects rig, controller and move; the moment is
/// the state of the move.
#include <optional>
#include <string_view>

#include "crane/configuration/rig.hpp"
#include "crane/control/law.hpp"

namespace crane::campaign {

/// The six moments of docs/campaign.md.
enum class Moment : std::uint8_t {
  armed_idle,         ///< HOLD without a request
  brake_release,      ///< the tick in which the brakes are commanded open
  peak_acceleration,  ///< RUN: the axis accelerates
  cruise,             ///< RUN: the axis has reached its largest speed
  limit,              ///< RUN: the axis brakes before the end of its permitted travel
  stop                ///< a stop by the operator is in progress
};
inline constexpr std::size_t kMoments = 6;
[[nodiscard]] std::string_view name_of(Moment moment) noexcept;
/// @return nothing when no moment has this name
[[nodiscard]] std::optional<Moment> moment_named(std::string_view name) noexcept;

struct Setting {
  configuration::Rig configured;  ///< rig file of the components
  configuration::Rig actual;      ///< parameters of the simulated rig
  const control::Controller* controller = nullptr;
  std::array<bool, 3> selected{};  ///< axes that move
  std::array<double, 3> target{};  ///< m, rad, m of cable
  std::size_t axis = 0;            ///< axis of the fault
  bool ledger = false;             ///< true: the processes have a ledger (crane/bus/ledger.hpp)
};

inline constexpr std::uint64_t kSettings = 12;
/// @param number  < kSettings
[[nodiscard]] Setting setting(std::uint64_t number, Moment moment);

}  // namespace crane::campaign
