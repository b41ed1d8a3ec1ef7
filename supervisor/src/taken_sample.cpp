#include "taken_sample.hpp"

#include <algorithm>
#include <cmath>

namespace crane::supervisor {
namespace {

// largest value of the counters, which would overflow if a stream were missing for months
constexpr int kCounterEnd = 1'000'000;

bool all_finite(const Sample& sample) {
  return std::isfinite(sample.time_s) &&
         std::ranges::all_of(sample.position, [](double x) { return std::isfinite(x); }) &&
         std::ranges::all_of(sample.applied_v, [](double x) { return std::isfinite(x); }) &&
         std::isfinite(sample.swing_radial_rad) && std::isfinite(sample.swing_tangential_rad);
}

}  // namespace

void take_over_bridge(const Limits& limits, const TickInput& input, TickMemory& memory) {
  if (!input.bridge_restarted) return;
  AxisFlags known{};
  for (std::size_t i = 0; i < kAxes; ++i) known[i] = !memory.sample.position_unknown[i];
  const bool usable = input.state_arrived && all_finite(input.sample);
  take_over(limits, input.now_s, memory.motion, known, usable ? &input.sample.position : nullptr,
            memory.restart);
  memory.motion = {};
  memory.brakes = {};
  memory.relay = {};
  memory.following = {};
  memory.pendulum = {};
  memory.zones = {};
  memory.sample = {};
  memory.overruns_in_row = 0;
}

bool take_sample(const Limits& limits, const TickInput& input, TickMemory& memory) {
  if (!input.state_arrived || !all_finite(input.sample)) {
    memory.state_missing_in_row = std::min(memory.state_missing_in_row + 1, kCounterEnd);
    return false;
  }
  memory.state_missing_in_row = 0;
  const bool late = memory.motion.started && input.sample.overruns != memory.sample.overruns;
  memory.overruns_in_row = late ? std::min(memory.overruns_in_row + 1, kCounterEnd) : 0;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (memory.motion.started && memory.sample.position_unknown[i] && !input.sample.position_unknown[i])
      set_homed_position(i, input.sample.position[i], memory.motion, memory.brakes);
  memory.sample = input.sample;
  observe(limits, input.now_s, input.sample.time_s, input.sample.position, memory.motion);
  for (std::size_t i = 0; i < kAxes; ++i)  // homing ends the doubt about a position
    if (memory.sample.position_unknown[i]) memory.restart.doubtful[i] = false;
  watch_load(limits, input.now_s, memory.sample.swing_radial_rad, memory.sample.swing_tangential_rad,
             memory.restart);
  return true;
}

}  // namespace crane::supervisor
