/// Cost of one tick (10 ms) of the simulated plant in motion with friction, compared with lower bounds.
#include <benchmark/benchmark.h>

#include "closed_loop.hpp"
#include "crane/simulator/integrator.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace {

using crane::plant::Model;
using crane::plant::Parameters;
using crane::plant::State;

const Parameters kCrane{};
const State kMoving{.trolley_m = 0.6,
                    .radial_rad = 0.08,
                    .slew_rad = 0.5,
                    .tangential_rad = -0.05,
                    .cable_m = 1,
                    .trolley_mps = 0.4,
                    .radial_radps = -0.1,
                    .slew_radps = 0.6,
                    .tangential_radps = 0.2};

void one_right_hand_side(benchmark::State& run) {
  const Model model{kCrane, crane::test::rig_friction()};
  const auto actuation = crane::test::driven({3, 2, 0});
  State s = kMoving;
  for (auto step : run) {
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(model.accelerations(s, actuation));
  }
}
BENCHMARK(one_right_hand_side);

/// Four steps of 2.5 ms have about the accuracy of the integrator while all axes move; near standstill the
/// friction needs steps of at most 0.1 ms.
void fixed_step_runge_kutta(benchmark::State& run) {
  const Model model{kCrane, crane::test::rig_friction()};
  const auto actuation = crane::test::driven({3, 2, 0});
  const auto steps = run.range(0);
  for (auto step : run) {
    State s = kMoving;
    for (std::int64_t i = 0; i < steps; ++i) {
      s = crane::test::runge_kutta_step(model, s, actuation,
                                        crane::test::kTick_s / static_cast<double>(steps));
    }
    benchmark::DoNotOptimize(s);
  }
}
BENCHMARK(fixed_step_runge_kutta)->Arg(4)->Arg(100);

using crane::simulator::Method;

void one_tick_moving(benchmark::State& run, Method method) {
  Model model{kCrane, crane::test::rig_friction()};
  crane::simulator::Integrator integrator{model, {}, method};
  for (auto step : run) {
    State s = kMoving;
    integrator.advance(s, crane::test::driven({3, 2, 0}), crane::test::kTick_s);
    benchmark::DoNotOptimize(s);
  }
  run.counters["evaluations"] =
      static_cast<double>(integrator.evaluations()) / static_cast<double>(run.iterations());
}
BENCHMARK_CAPTURE(one_tick_moving, cvode, Method::cvode);
BENCHMARK_CAPTURE(one_tick_moving, fast, Method::fast);

/// Maneuver 3 in closed loop: motion, reversal, standstill.
void ticks_of_maneuver_3(benchmark::State& run, Method method) {
  Model model{kCrane, crane::test::rig_friction()};
  crane::simulator::Integrator integrator{model, {}, method};
  State s;
  int tick = 0;
  for (auto step : run) {
    if (tick++ % 600 == 0) s = State{.trolley_m = crane::test::kManeuver3.start_trolley_m};
    const auto volts = crane::test::compensated(kCrane, s, crane::test::kManeuver3);
    integrator.advance(s, crane::test::driven(volts), crane::test::kTick_s);
  }
  run.counters["evaluations"] =
      static_cast<double>(integrator.evaluations()) / static_cast<double>(run.iterations());
}
BENCHMARK_CAPTURE(ticks_of_maneuver_3, cvode, Method::cvode);
BENCHMARK_CAPTURE(ticks_of_maneuver_3, fast, Method::fast);

/// The same with the simulated board: counters, converters, brakes, watchdog.
void board_ticks_moving(benchmark::State& run, Method method) {
  crane::simulator::SimulatedRig rig;
  rig.integrator = method;
  rig.terms = crane::test::rig_friction();
  crane::simulator::SimulatedBoard board{rig};
  crane::bridge::Outputs outputs;
  outputs.brake_release = {true, true, true};
  std::int64_t tick = 0;
  for (auto step : run) {
    benchmark::DoNotOptimize(board.read());
    outputs.watchdog_level = !outputs.watchdog_level;
    const double direction = (tick / 200) % 2 == 0 ? 1 : -1;  // to and fro
    outputs.drive_v = {3 * direction, 2 * direction, 0.1 * direction};
    board.write(outputs);
    board.advance_to(++tick * 10'000'000);
  }
}
BENCHMARK_CAPTURE(board_ticks_moving, cvode, Method::cvode);
BENCHMARK_CAPTURE(board_ticks_moving, fast, Method::fast);

}  // namespace
