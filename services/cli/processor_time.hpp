#pragma once
/// Processor time of a process of the stack, for its loop and for the threads of its DDS implementation.
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "crane/runtime/wiring.hpp"
#include "stack/child_processes.hpp"

namespace crane::cli {

/// Sum of the scheduler statistics of some threads since their start (/proc/PID/task/TID/schedstat).
struct ThreadTime {
  std::int64_t running_ns = 0;
  std::int64_t waiting_ns = 0;  ///< ready to run, but no processor was free
  std::int64_t runs = 0;        ///< number of times that a thread was scheduled
};

/// The first thread of a process of the stack is its loop.
struct ProcessTime {
  ThreadTime loop, others;
};
[[nodiscard]] ProcessTime time_of_process(pid_t pid);

/// Times per tick.
struct ThreadShare {
  double running_us = 0, waiting_us = 0, runs = 0;
};
struct ProcessShare {
  std::string process;
  ThreadShare loop, others;
};

/// Measures the processes of a stack from its construction on.
class ProcessorTimes {
 public:
  ProcessorTimes(const stack::ChildProcesses& children, const std::vector<runtime::ComponentSpec>& specs);
  /// @param ticks  since the construction
  [[nodiscard]] std::vector<ProcessShare> per_tick(double ticks) const;

 private:
  struct Measured {
    std::string process;
    pid_t pid;
    ProcessTime begin;
  };
  std::vector<Measured> measured_;
};

}  // namespace crane::cli
