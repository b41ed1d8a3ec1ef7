#pragma once
/// Shared by the programs that run components: real-time scheduling, the log, and the exit codes of main().
#include <functional>
#include <string>

#include "crane/runtime/component.hpp"
#include "crane/runtime/process.hpp"
#include "crane/runtime/realtime_scheduling.hpp"

namespace crane::runtime {

inline constexpr std::int64_t kLongest_ns = 100'000'000;  // longest reaction time to a stop signal

/// Requests real-time scheduling for this process (RealtimeScheduling::enter()) and sets the limit of
/// limit_spin_time(). Logs a warning of `node` when the system denies a request.
/// @param priority  0: ordinary scheduling
void enter_realtime(RealtimeScheduling& scheduling, Node& node, int priority);

/// @throws configuration::ConfigurationError for an unknown name
[[nodiscard]] Clock clock_from(const std::string& name);

/// Parses the options of a process of the loop, prepares log and signals, and calls `run`.
/// @return the exit code of `run`, or the code of the exception that ended it
int host(int argc, char** argv, const std::string& program, const std::string& summary,
         const std::function<int(const LoopOptions&)>& run);

}  // namespace crane::runtime
