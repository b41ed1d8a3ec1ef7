#pragma once
/// Names of the protections outside the rule table of the supervisor; supervisor/src/rules.cpp names the
/// rules. A build with CRANE_MUTATION can disable one protection; tests/campaign then shows that a fault
/// violates an invariant. In every other build, `enabled` is true, and the compiler removes the check.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace crane::protection {

// Supervisor: command echo, gate, requests and brakes.
// Bridge: checks in the order of hardware_bridge/src/checks.cpp. Bus: checksum, writer binding, ledger.
#define CRANE_PROTECTIONS(X)   \
  X(supervisor_echo)           \
  X(supervisor_sole)           \
  X(supervisor_bridge_clock)   \
  X(gate_range)                \
  X(gate_rate)                 \
  X(gate_block_outwards)       \
  X(request_target)            \
  X(request_id)                \
  X(reset_edge)                \
  X(reset_clear_time)          \
  X(reset_position_doubtful)   \
  X(reset_swing_zero_doubtful) \
  X(arm_fresh_time)            \
  X(brake_slip)                \
  X(brake_report)              \
  X(bridge_second_writer)      \
  X(bridge_command_stale)      \
  X(bridge_command_not_finite) \
  X(bridge_command_range)      \
  X(bridge_command_rate)       \
  X(bridge_not_homed)          \
  X(bridge_encoder_jump)       \
  X(bridge_lost_counts)        \
  X(bridge_position)           \
  X(bridge_speed)              \
  X(bridge_swing)              \
  X(bridge_braked_motion)      \
  X(bridge_encoder_frozen)     \
  X(bridge_drive_response)     \
  X(bridge_latch_is_kept)      \
  X(bus_checksum)              \
  X(bus_checksum_of_topic)     \
  X(bus_source)                \
  X(bus_one_writer)            \
  X(bus_ledger)

enum class Protection : std::uint8_t {
#define CRANE_DECLARE_PROTECTION(name) name,
  CRANE_PROTECTIONS(CRANE_DECLARE_PROTECTION)
#undef CRANE_DECLARE_PROTECTION
};

#define CRANE_NAME_PROTECTION(name) #name,
inline constexpr std::array kNames{CRANE_PROTECTIONS(CRANE_NAME_PROTECTION)};
#undef CRANE_NAME_PROTECTION
inline constexpr std::size_t kProtections = kNames.size();

#ifdef CRANE_MUTATION
inline namespace mutated {
[[nodiscard]] bool enabled(std::string_view rule) noexcept;  // tests/campaign/mutation.cpp
[[nodiscard]] inline bool enabled(Protection protection) noexcept {
  return enabled(std::string_view{kNames[static_cast<std::size_t>(protection)]});
}
}  // namespace mutated
#else
[[nodiscard]] constexpr bool enabled(std::string_view /*rule*/) noexcept { return true; }
[[nodiscard]] constexpr bool enabled(Protection /*protection*/) noexcept { return true; }
#endif

}  // namespace crane::protection
