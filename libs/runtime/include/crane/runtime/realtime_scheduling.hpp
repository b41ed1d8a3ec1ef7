#pragma once
/// SCHED_FIFO and locked memory for a process of the loop, until its work ends.
namespace crane::runtime {

class RealtimeScheduling {
 public:
  /// Answers of the system to enter(): 0 or errno.
  struct Answer {
    int memory = 0;      ///< of the request to lock the memory
    int scheduling = 0;  ///< of the request for SCHED_FIFO; the first denied thread
  };

  RealtimeScheduling() = default;
  RealtimeScheduling(const RealtimeScheduling&) = delete;
  RealtimeScheduling& operator=(const RealtimeScheduling&) = delete;
  /// Returns all threads to ordinary scheduling. The kernel frees the memory of an ending process with the
  /// priority of that process: freeing the locked memory of six processes occupies two processors for 30 ms.
  /// With real-time priority, this would stop another crane on the same computer.
  ~RealtimeScheduling();

  /// Locks the memory and requests SCHED_FIFO for every thread of this process, because the receive threads
  /// of the bus need the priority of the loop. Call this last: start-up work must not preempt running
  /// processes.
  /// @param priority  1 to 99 (LoopOptions: at most 98); 0 or less: does nothing
  [[nodiscard]] Answer enter(int priority);

 private:
  bool entered_ = false;
};

}  // namespace crane::runtime
