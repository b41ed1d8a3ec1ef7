#include "trajectory_planner/plan_worker.hpp"

#include <pthread.h>
#include <sched.h>

#include <utility>

namespace crane::services {

PlanWorker::PlanWorker(const control::Design& design, bool own_thread) : design_{design} {
  if (own_thread) thread_ = std::thread{[this] { work(); }};
}

PlanWorker::~PlanWorker() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock{mutex_};
    ends_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool PlanWorker::ask(const control::PlanProblem& problem) {
  if (!thread_.joinable()) {
    result_ = control::time_optimal_plan(design_, problem);
    return true;
  }
  const std::unique_lock lock{mutex_, std::try_to_lock};
  if (!lock) return false;
  problem_ = problem;
  result_.reset();
  wake_.notify_one();
  return true;
}

std::optional<control::PlanResult> PlanWorker::take() {
  const std::unique_lock lock{mutex_, std::try_to_lock};
  if (!lock) return std::nullopt;
  return std::exchange(result_, std::nullopt);
}

void PlanWorker::work() {
  const sched_param ordinary{};
  // Ordinary priority: the thread never delays the loop.
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
  std::unique_lock lock{mutex_};
  for (;;) {
    wake_.wait(lock, [this] { return ends_ || problem_; });
    if (ends_) return;
    const control::PlanProblem problem = *std::exchange(problem_, std::nullopt);
    lock.unlock();
    const control::PlanResult result = control::time_optimal_plan(design_, problem);
    lock.lock();
    if (!problem_) result_ = result;  // otherwise a newer move has replaced this problem
  }
}

}  // namespace crane::services
