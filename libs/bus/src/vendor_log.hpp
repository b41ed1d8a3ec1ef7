#pragma once
/// What a DDS implementation has to say about its peers. Anybody on the network can make it talk, and a line
/// that waits for a stopped terminal would hold up a receive thread: the first lines go to standard error,
/// the rest is dropped.
#include <string_view>

namespace crane::bus {

/// Thread-safe. @param line  with or without a line break at its end
void vendor_log(std::string_view vendor, std::string_view line) noexcept;

}  // namespace crane::bus
