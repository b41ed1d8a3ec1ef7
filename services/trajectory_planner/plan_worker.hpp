#pragma once
/// Solves time-optimal plans outside the control loop. In real time, a thread of ordinary priority solves;
/// the loop never waits for this thread, because take() returns nothing while it is busy. In lockstep, ask()
/// solves immediately, so that runs repeat bit for bit.
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "crane/control/time_optimal.hpp"

namespace crane::services {

class PlanWorker {
 public:
  PlanWorker(const control::Design& design, bool own_thread);
  ~PlanWorker();
  PlanWorker(const PlanWorker&) = delete;
  PlanWorker& operator=(const PlanWorker&) = delete;

  /// Begins to solve a problem and discards the result of the previous problem. @return false when the thread
  /// holds the lock; call again at the next tick
  bool ask(const control::PlanProblem& problem);
  /// Takes the result of the last ask(); nothing while the thread solves, and after the result was taken.
  [[nodiscard]] std::optional<control::PlanResult> take();

 private:
  void work();

  control::Design design_;
  std::mutex mutex_;  ///< held only to copy a problem or a plan
  std::condition_variable wake_;
  std::optional<control::PlanProblem> problem_;
  std::optional<control::PlanResult> result_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace crane::services
