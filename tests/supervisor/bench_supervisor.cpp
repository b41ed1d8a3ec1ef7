// Cost of the checks of one tick while the crane moves: gate, envelope, following error, swing encoders,
// zones. The counter `allocations` is per tick.
#include <benchmark/benchmark.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "crane/configuration/rig.hpp"
#include "crane/supervisor/component.hpp"
#include "crane/supervisor/supervisor.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}

// Not inlined, so that the compiler does not pair malloc with the delete of the library.
[[gnu::noinline]] void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc{};
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

namespace {

using namespace crane::supervisor;

constexpr double kTick_s = 0.01;

Limits tower() {
  return limits_of(crane::configuration::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml"));
}

/// A crane whose axes and load move. The positions have no influence on the time.
Sample sample_at(double time_s) {
  const double s = std::sin(time_s);
  return {.time_s = time_s,
          .position = {0.7 + 0.3 * s, 0.5 * s, 1},
          .swing_radial_rad = 0.1 * s,
          .swing_tangential_rad = 0.1 * s,
          .applied_v = {2 * s, s, 0}};
}

void count(benchmark::State& run, std::size_t before) {
  run.counters["allocations"] = benchmark::Counter(static_cast<double>(allocations.load() - before),
                                                   benchmark::Counter::kAvgIterations);
}

void gate_envelope_following_error(benchmark::State& run) {
  const Limits limits = tower();
  GateMemory gate_memory;
  FollowingMemory following;
  double time_s = 1;
  const std::size_t before = allocations;
  for (auto _ : run) {
    time_s += kTick_s;
    const Sample sample = sample_at(time_s);
    const Envelope envelope = check_envelope(limits, {.position = sample.position, .speed = {0.3, 0.5, 0}});
    benchmark::DoNotOptimize(gate(limits,
                                  {.arrived = true,
                                   .demand_v = sample.applied_v,
                                   .drives_active = true,
                                   .block_positive = envelope.block_positive,
                                   .block_negative = envelope.block_negative},
                                  gate_memory));
    const FollowingInput in = following_input(sample, {true, true, true});
    benchmark::DoNotOptimize(following_error(limits, in, following));
  }
  count(run, before);
}
BENCHMARK(gate_envelope_following_error)->Unit(benchmark::kMicrosecond);

void swing_encoders(benchmark::State& run) {
  const Limits limits = tower();
  PendulumMemory memory;
  double time_s = 1;
  const std::size_t before = allocations;
  for (auto _ : run) {
    time_s += kTick_s;
    benchmark::DoNotOptimize(swing_sensor_failed(limits, pendulum_input(sample_at(time_s)), memory));
  }
  count(run, before);
}
BENCHMARK(swing_encoders)->Unit(benchmark::kMicrosecond);

void zone_filter(benchmark::State& run) {
  Limits limits = tower();
  limits.clearance = {.load_radius_m = 0.1, .suspension_height_m = 2};
  for (int i = 0; i < run.range(0); ++i)
    limits.zones.push_back(
        {.name = "zone", .position_x_m = -2.0 - i, .size_x_m = 1, .size_y_m = 1, .top_m = 1.5});
  ZoneMemory memory;
  double time_s = 1;
  const std::size_t before = allocations;
  for (auto _ : run) {
    time_s += kTick_s;
    const Sample sample = sample_at(time_s);
    const ZoneInput in{.sampled_s = time_s,
                       .position = sample.position,
                       .speed = {0.3 * std::cos(time_s), 0.5 * std::cos(time_s), 0},
                       .swing_radial_rad = sample.swing_radial_rad,
                       .swing_tangential_rad = sample.swing_tangential_rad,
                       .applied_v = sample.applied_v,
                       .gate_output_v = sample.applied_v};
    observe_load(limits, in, memory);
    benchmark::DoNotOptimize(filter_zones(limits, in, memory));
  }
  count(run, before);
}
BENCHMARK(zone_filter)->Arg(1)->Arg(10)->Arg(100)->Unit(benchmark::kMicrosecond);

void whole_step(benchmark::State& run) {
  const Limits limits = tower();
  TickMemory memory;
  TickInput input{.state_arrived = true, .demand_arrived = true, .self_test = SelfTest::passed};
  memory.machine.state = State::run;
  memory.machine.releasing = true;
  const std::size_t before = allocations;
  for (auto _ : run) {
    input.now_s += kTick_s;
    input.sample = sample_at(input.now_s);
    input.demand_v = input.sample.applied_v;
    memory.machine.state = State::run;  // independent of the result for these samples
    benchmark::DoNotOptimize(step(limits, input, memory));
  }
  count(run, before);
}
BENCHMARK(whole_step)->Unit(benchmark::kMicrosecond);

}  // namespace
