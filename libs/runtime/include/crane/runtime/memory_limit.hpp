#pragma once
/// Ends a process whose memory grows without bound.
#include <cstddef>

namespace crane::runtime {

/// Data that a process may allocate after its start [bytes]. A process of the loop allocates about 60 MB,
/// most of it for the locked stacks of its threads.
inline constexpr std::size_t kMostGrowth_bytes = std::size_t{512} << 20U;

/// From now on this process can allocate at most kMostGrowth_bytes: later allocations fail, and the process
/// ends by an exception or by SIGABRT. Every participant, writer and instance on the bus occupies memory of
/// each process that discovers it, as long as it exists. Without this limit, a program without keys fills the
/// memory of the computer while the crane holds its position with open brakes. When the process has ended,
/// its silence stops the crane.
/// @throws std::system_error
void end_when_growing();

}  // namespace crane::runtime
