#pragma once
/// Limits the messages of a DDS implementation about its peers. Any program on the network can cause such
/// messages, and a write to a stopped terminal would block a receive thread. The first lines are written to
/// standard error; all later lines are dropped.
#include <string_view>

namespace crane::bus {

/// Thread-safe. @param line  with or without a line break at its end
void vendor_log(std::string_view vendor, std::string_view line) noexcept;

}  // namespace crane::bus
