#include "crane/supervisor/states.hpp"

namespace crane::supervisor {
namespace {

constexpr std::array<const char*, kCauses> kCauseNames{
#define CRANE_CAUSE(name, text) text,
#include "crane/causes.def"
#undef CRANE_CAUSE
};

constexpr std::array<const char*, kStates> kStateNames{
    "BOOT", "SELFTEST", "LOCKED", "READY", "ARMING", "HOLD", "RUN", "STOP_C1", "STOP_C0", "ESTOP", "FAULT"};

struct FailureEntry {
  const char* name;
  const char* remedy;
};
// In the order of the enumeration.
constexpr std::array<FailureEntry, kHomingFailures> kFailures{{
    {"NONE", ""},
    {"MARK_NOT_FOUND",
     "the axis did not find its mark within the search distance: check switch and counts per unit"},
    {"MARK_STUCK", "the switch of the mark does not open when the axis backs off: check switch and wiring"},
    {"OTHER_SWITCH", "the axis reached a limit switch that is not its mark: check mark, signs and wiring"},
    {"NO_MOTION", "the axis does not follow its reference: check encoder, brake and drive"},
    {"MARK_DISAGREES",
     "the second pass did not confirm the mark: the axis was faster than twice approach_speed (swinging "
     "load, gains, friction compensation), or the positions differ (coupling, encoder, switch)"},
}};

}  // namespace

const char* name_of(State state) noexcept { return kStateNames[static_cast<std::size_t>(state)]; }
const char* name_of(Cause cause) noexcept { return kCauseNames[static_cast<std::size_t>(cause)]; }
bool is_routine(Cause cause) noexcept {
  return cause == Cause::start || cause == Cause::homed || cause == Cause::operator_disarm ||
         cause == Cause::idle;
}
const char* name_of(HomingFailure failure) noexcept {
  return kFailures[static_cast<std::size_t>(failure)].name;
}
const char* remedy_for(HomingFailure failure) noexcept {
  return kFailures[static_cast<std::size_t>(failure)].remedy;
}

}  // namespace crane::supervisor
