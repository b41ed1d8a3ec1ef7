#pragma once
/// Faults of the campaign with real processes, and the expected reaction to each.
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <string>
#include <string_view>

#include "recorded_run.hpp"

namespace crane::system_test {

/// State of the crane when the fault begins.
enum class When : std::uint8_t { idle, moving, stopping };
inline constexpr std::array kMoments{"armed idle", "moving", "stopping"};

struct Fault {
  const char* component;  ///< process that gets the signal; null: a forged topic
  int signal;             ///< SIGKILL or SIGSTOP; 0: a forged topic
  const char* topic;      ///< forged topic; null: a signal
  const char* vendor;     ///< DDS vendor of the forger; empty: a signal
};
inline constexpr std::array kFaults{Fault{"trajectory_planner", SIGKILL, nullptr, ""},
                                    Fault{"trajectory_planner", SIGSTOP, nullptr, ""},
                                    Fault{"tracking", SIGKILL, nullptr, ""},
                                    Fault{"tracking", SIGSTOP, nullptr, ""},
                                    Fault{"anti_swing", SIGKILL, nullptr, ""},
                                    Fault{"anti_swing", SIGSTOP, nullptr, ""},
                                    Fault{"friction_compensation", SIGKILL, nullptr, ""},
                                    Fault{"friction_compensation", SIGSTOP, nullptr, ""},
                                    Fault{"supervisor", SIGKILL, nullptr, ""},
                                    Fault{"supervisor", SIGSTOP, nullptr, ""},
                                    Fault{nullptr, 0, "command", "cyclone"},
                                    Fault{nullptr, 0, "demand", "fastdds"},
                                    Fault{nullptr, 0, "tracking", "cyclone"},
                                    Fault{nullptr, 0, "anti_swing", "fastdds"},
                                    Fault{nullptr, 0, "reference", "cyclone"},
                                    Fault{nullptr, 0, "state", "cyclone"},
                                    Fault{nullptr, 0, "supervisor", "fastdds"}};

inline std::string name_of(const Fault& fault, When when) {
  const std::string what =
      fault.component != nullptr
          ? std::string{fault.signal == SIGKILL ? "SIGKILL" : "SIGSTOP"} + " to " + fault.component
          : "forged " + std::string{fault.topic} + " from " + fault.vendor;
  return what + ", " + kMoments[static_cast<std::size_t>(when)];
}

/// A second writer is detected after its discovery, which takes up to a second between two vendors.
inline constexpr auto kFound = std::chrono::milliseconds{1500};
/// Largest delay of a tick that is no overrun (docs/safety.md); a signal may have the same delay.
inline constexpr double kLate_ms = 5;

/// Expected reaction: as in the campaign in virtual time, plus the delay of real ticks.
inline campaign::Expectation expectation_of(const Fault& fault) {
  if (fault.component == nullptr)
    return {.reasons = {{crane_CAUSE_SECOND_WRITER, crane_LATCH_NONE},
                        {crane_CAUSE_BRIDGE_LATCHED, crane_LATCH_SECOND_WRITER}},
            .detection_ms = std::chrono::duration<double, std::milli>{kFound}.count(),
            .bridge_delay_ms = kLate_ms};
  if (std::string_view{fault.component} == "supervisor")
    return {.reasons = {{crane_CAUSE_BRIDGE_LATCHED, crane_LATCH_COMMAND_STALE}},
            .detection_ms = 60 + kLate_ms,
            .communication = true,
            .supervisor_gone = true,
            .bridge_delay_ms = kLate_ms};
  return {.reasons = {{crane_CAUSE_DEMAND_STALE, crane_LATCH_NONE}},
          .detection_ms = 50 + kLate_ms,
          .communication = true,
          .bridge_delay_ms = kLate_ms};
}

}  // namespace crane::system_test
