#pragma once
/// Judges one run by the invariants of docs/campaign.md. The judge uses topics, limits of the rig file and
/// the true state, and shares no code with supervisor and bridge.
#include <string>

#include "campaign/judge/record.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::campaign {

enum class Invariant : std::uint8_t {
  inside_limits,     ///< I1: an axis whose brake is open is inside its hard limits
  zero_volts,        ///< I2: 0 V within 70 ms of a communication fault, within 20 ms of a detection
  brakes_commanded,  ///< I3: brakes commanded closed with 0 V for C0, at standstill for C1
  braked_stays,      ///< I4: no motion after a closed brake has stopped its axis
  reset_and_arm,     ///< I5: no brake opens without reset and then arm
  only_supervisor,   ///< I6: the drives get the published command of the supervisor, or 0 V
  volts_in_range,    ///< I7: |u| and its change are within the limits of the drive
  right_reason,      ///< I8: the first reason is an expected one, within its detection time
  recoverable,       ///< I9: an interrupted recording loses at most the last second
  no_false_trip      ///< I10: nothing stops a crane without a fault
};
inline constexpr std::size_t kInvariants = 10;
[[nodiscard]] const char* name_of(Invariant invariant) noexcept;  ///< "I1 inside hard limits"

struct Violation {
  Invariant invariant;
  std::int64_t time_ns = 0;
  std::string what;
};

struct Verdict {
  std::vector<Violation> violations;
  std::optional<Reason> first;          ///< reason of the first stop after the onset
  std::optional<double> detection_ms;   ///< from the visibility of the fault to the first reason
  std::optional<double> zero_volts_ms;  ///< from the visibility of the fault to 0 V
  std::optional<double> braked_ms;      ///< from the visibility of the fault to closed brakes
  double beyond_limit = 0;  ///< largest distance of an axis with open brake from a hard limit, m or rad
};

[[nodiscard]] Verdict judge(const configuration::Rig& rig, const Run& run);

}  // namespace crane::campaign
