#pragma once
/// Limits the memory of a process (RLIMIT_DATA).
#include <cstddef>

namespace crane::runtime {

/// Data that a process may allocate after its start [bytes]. A process of the loop allocates about 60 MB,
/// most of it for the locked stacks of its threads.
inline constexpr std::size_t kMostGrowth_bytes = std::size_t{512} << 20U;

/// From now on this process can allocate at most kMostGrowth_bytes. Further allocations fail, and the process
/// ends by an exception or by SIGABRT; its silence then stops the crane. A lower limit of the administrator
/// remains in force. Every participant, writer and instance on the bus occupies memory of each process that
/// discovers it: without a limit, a program without keys could fill the memory of the computer while the
/// crane holds its position with open brakes.
/// @throws std::system_error
void limit_memory_growth();

}  // namespace crane::runtime
