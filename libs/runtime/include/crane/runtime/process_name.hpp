#pragma once
/// Names of the processes for messages and tools.
#include <array>

#include "crane/topics.hpp"

namespace crane::runtime {

/// In the order of crane_Source.
inline constexpr std::array kProcessNames{"nobody",
                                          "plant",
                                          "hardware_bridge",
                                          "trajectory_planner",
                                          "tracking",
                                          "anti_swing",
                                          "friction_compensation",
                                          "supervisor",
                                          "operator",
                                          "recorder",
                                          "monitor",
                                          "twin"};
static_assert(kProcessNames.size() == crane_SOURCE_TWIN + 1);

/// @param source  may be a number of a newer program: "unknown"
[[nodiscard]] constexpr const char* process_name(crane_Source source) {
  const auto number = static_cast<std::size_t>(source);
  return number < kProcessNames.size() ? kProcessNames[number] : "unknown";
}

}  // namespace crane::runtime
