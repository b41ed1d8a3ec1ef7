/// The plan worker returns the plan of the newest problem, equal to a plan without a thread. The thread
/// sanitizer runs these tests, too (deploy/test --all).
#include "trajectory_planner/plan_worker.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

namespace crane::services {
namespace {

using Result = std::optional<control::PlanResult>;

control::PlanProblem problem_to(double trolley_m) {
  control::PlanProblem problem;
  problem.from = {0.25, 0};
  problem.to = {trolley_m, 0};
  return problem;
}

/// Calls ask() at every tick, and again when the thread holds the lock.
void ask(PlanWorker& worker, const control::PlanProblem& problem) {
  while (!worker.ask(problem)) std::this_thread::yield();
}

/// The next result; nothing after a minute, several thousand times the duration of a plan.
std::unique_ptr<Result> next_result(PlanWorker& worker) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes{1};
  auto result = std::make_unique<Result>();
  while (!*result && std::chrono::steady_clock::now() < end) {
    *result = worker.take();
    std::this_thread::yield();
  }
  return result;
}

class PlanWorkers : public testing::TestWithParam<bool> {};

TEST_P(PlanWorkers, GiveThePlanOfTheProblemOnce) {
  PlanWorker worker{control::Design{}, GetParam()};
  ask(worker, problem_to(1.0));
  const auto result = next_result(worker);
  ASSERT_TRUE(*result);
  ASSERT_EQ((*result)->outcome, control::PlanOutcome::solved);
  const auto right = control::time_optimal_plan(control::Design{}, problem_to(1.0));
  EXPECT_EQ((*result)->plan.duration_s, right.plan.duration_s);
  EXPECT_EQ((*result)->plan.state.back(), right.plan.state.back());
  EXPECT_FALSE(worker.take());
}

TEST_P(PlanWorkers, DropThePlanOfAnEarlierProblem) {
  PlanWorker worker{control::Design{}, GetParam()};
  for (const double trolley_m : {0.4, 0.6, 0.8, 1.0}) ask(worker, problem_to(trolley_m));
  const auto result = next_result(worker);
  ASSERT_TRUE(*result);
  EXPECT_NEAR((*result)->plan.state.back()[0], 1.0, 1e-6);
}

TEST_P(PlanWorkers, EndWhileAProblemIsBeingSolved) {
  PlanWorker worker{control::Design{}, GetParam()};
  ask(worker, problem_to(1.0));
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutThread, PlanWorkers, testing::Bool(),
                         [](const auto& test) { return test.param ? "thread" : "lockstep"; });

}  // namespace
}  // namespace crane::services
