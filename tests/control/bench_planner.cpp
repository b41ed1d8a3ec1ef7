/// Times of the time-optimal planner for random moves of the dissertation's tower, with and without a similar
/// plan as initial guess. Prints outcome, iterations and processor time per plan: p50, p99, maximum.
///   bench_planner [moves] [seed]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <random>
#include <vector>

#include "crane/control/time_optimal.hpp"

namespace crane::control {
namespace {

double processor_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

Design with_friction() {
  Design design;  // deploy/rigs/virginia_tech_tower.toml
  design.friction[kTrolley] = {1.5, 6.0, 0.9, 1.2, 0.9, 1.2, 100, 0.005, 1};
  design.friction[kSlew] = {0.15, 0.05, 0.7, 0.6, 0.7, 0.6, 100, 0.005, 1};
  return design;
}

struct Times {
  std::vector<double> ms, iterations;
  int solved = 0;
  void add(const PlanResult& result, double spent_ms) {
    ms.push_back(spent_ms);
    iterations.push_back(result.iterations);
    solved += result.outcome == PlanOutcome::solved ? 1 : 0;
  }
  void print(const char* name) {
    if (ms.empty()) return;
    std::sort(ms.begin(), ms.end());
    std::sort(iterations.begin(), iterations.end());
    const auto quantile = [](const std::vector<double>& v, double q) {
      return v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))];
    };
    std::printf(
        "%-5s %5zu moves, %5d solved, processor time [ms] p50 %.1f, p99 %.1f, max %.1f, iterations p50 %.0f, "
        "max %.0f\n",
        name, ms.size(), solved, quantile(ms, 0.5), quantile(ms, 0.99), ms.back(), quantile(iterations, 0.5),
        iterations.back());
  }
};

void run(int moves, unsigned seed) {
  const Design design = with_friction();
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Times cold, warm;
  for (int i = 0; i < moves; ++i) {
    PlanProblem problem;
    problem.limits = {.volts = {9.5, 9.5}, .low = {0.19, -2.74}, .high = {1.31, 2.74}, .speed = {1.35, 3.15}};
    problem.from = {between(0.25, 1.25), between(-2.5, 2.5)};
    problem.to = {between(0.25, 1.25), between(-2.5, 2.5)};
    if (i % 3 == 0) problem.to[kSlew] = problem.from[kSlew];
    if (i % 3 == 1) problem.to[kTrolley] = problem.from[kTrolley];
    problem.cable_m = between(0.4, 1.5);
    double begin = processor_ms();
    const auto first = std::make_unique<PlanResult>(time_optimal_plan(design, problem));
    cold.add(*first, processor_ms() - begin);
    if (first->outcome != PlanOutcome::solved)
      std::printf(
          "  not solved: trolley %.4f to %.4f m, slew %.4f to %.4f rad, cable %.3f m, %d iterations\n",
          problem.from[0], problem.to[0], problem.from[1], problem.to[1], problem.cable_m, first->iterations);
    if (first->outcome != PlanOutcome::solved) continue;
    problem.to[kTrolley] = std::clamp(problem.to[kTrolley] + between(-0.03, 0.03), 0.2, 1.3);
    begin = processor_ms();
    const auto second = std::make_unique<PlanResult>(time_optimal_plan(design, problem, &first->plan));
    warm.add(*second, processor_ms() - begin);
  }
  cold.print("cold");
  warm.print("warm");
}

}  // namespace
}  // namespace crane::control

int main(int argc, char** argv) {
  const int moves = argc > 1 ? std::atoi(argv[1]) : 300;
  const unsigned seed = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1;
  crane::control::run(moves > 0 ? moves : 300, seed);
}
