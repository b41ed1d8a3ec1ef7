#pragma once
/// Bus of the commands that observe or operate a running crane.
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "crane/runtime/process.hpp"

namespace crane::cli {

/// Default bus options of a tool: Fast DDS, so that every run uses both vendors.
[[nodiscard]] inline runtime::BusOptions tool_bus() {
  runtime::BusOptions options;
  options.vendor = "fastdds";
  return options;
}

/// Participant for a tool. @throws bus::Error
[[nodiscard]] bus::Bus open_bus(const runtime::BusOptions& options,
                                crane_Source source = crane_SOURCE_MONITOR);

/// End of an error message: " for crane 'crane' in domain 0 on 127.0.0.1 …: remedy".
[[nodiscard]] std::string where_and_remedy(const bus::Options& options);
/// As above; if a program of this crane has another message version, the text names this program instead.
[[nodiscard]] std::string where_and_remedy(bus::Bus& bus);

/// Calls `poll` after each arrival of a sample, and at least every 20 ms, until it returns true.
/// @return false at the timeout or after a stop signal
bool wait_until(bus::Bus& bus, double timeout_s, const std::function<bool()>& poll);

}  // namespace crane::cli
