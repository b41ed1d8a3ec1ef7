#pragma once
/// What all commands that look at or talk to a running crane share.
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "crane/runtime/process.hpp"

namespace crane::cli {

/// Options of a tool: as every process's, but Fast DDS by default, so that an observer of the Cyclone loop
/// crosses vendors.
[[nodiscard]] inline runtime::BusOptions tool_bus() {
  runtime::BusOptions options;
  options.vendor = "fastdds";
  return options;
}

/// Participant for a tool. @throws bus::Error
[[nodiscard]] bus::Bus open_bus(const runtime::BusOptions& options,
                                crane_Source source = crane_SOURCE_MONITOR);

/// " for crane 'crane' in domain 0 on 127.0.0.1 …: what to check", the end of a sentence "nothing heard".
[[nodiscard]] std::string where_and_remedy(const bus::Options& options);

/// Waits for samples and calls `poll` after each arrival, and at least every 20 ms, until it returns true.
/// @return false when the time was up or the process was asked to stop
bool wait_until(bus::Bus& bus, double timeout_s, const std::function<bool()>& poll);

}  // namespace crane::cli
