#pragma once
/// Shared by the programs that host components: real-time scheduling, the log, and the exit codes of main().
#include <functional>
#include <string>

#include "crane/runtime/component.hpp"
#include "crane/runtime/process.hpp"

namespace crane::runtime {

inline constexpr std::int64_t kLongest_ns = 100'000'000;  // longest reaction time to a stop signal

/// Locks the memory and requests real-time scheduling for every thread of this process. The receive threads
/// of the bus need the same priority as the loop. Logs a warning when the system denies the request.
/// Real-time priority is requested last: start-up work must not preempt running processes.
/// @param priority  0: ordinary scheduling
void enter_realtime(Node& node, int priority);

/// @throws configuration::ConfigurationError for an unknown name
[[nodiscard]] Clock clock_from(const std::string& name);

/// Parses the options of a process of the loop, prepares log and signals, and calls `run`.
/// @return the exit code of `run`, or the code of the exception that ended it
int host(int argc, char** argv, const std::string& program, const std::string& summary,
         const std::function<int(const LoopOptions&)>& run);

}  // namespace crane::runtime
