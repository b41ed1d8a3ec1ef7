#include "crane/supervisor/gate.hpp"

#include <algorithm>
#include <cmath>

#include "crane/protection.hpp"

namespace crane::supervisor {
namespace {

using enum protection::Protection;
using protection::enabled;

// Increment of rate_pressure in a tick with limited rate; every other tick subtracts 1. An
// alternating demand (limited in every second tick) therefore stops the crane after 2 kPressure /
// (kPressure - 1) times as many ticks as a demand that is limited in every tick.
constexpr int kPressure = 4;
// largest value of the counters, which would overflow if a stream were missing for months
constexpr int kCountEnd = 1'000'000;

void limit_range(const Limits& limits, PerAxis& volts_v, GateOutput& output) noexcept {
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double limit_v = limits.axis[i].present ? limits.axis[i].volt_limit_v : 0;
    const double inside_v = std::clamp(volts_v[i], -limit_v, limit_v);
    output.clamped = output.clamped || (limits.axis[i].present && inside_v != volts_v[i]);
    volts_v[i] = inside_v;
  }
}

bool is_near_zero(const Limits& limits, const PerAxis& volts_v) noexcept {
  return std::ranges::all_of(volts_v, [&](double v) { return std::abs(v) <= limits.arm_volt_limit_v; });
}

void limit_rate(const Limits& limits, GateMemory& memory, PerAxis& volts_v, GateOutput& output) noexcept {
  constexpr double kRounding_v = 1e-9;
  bool clamped = false;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double step_v = limits.axis[i].volt_rate_limit_vps * limits.period_s;
    const double reachable_v = std::clamp(volts_v[i], memory.last_v[i] - step_v, memory.last_v[i] + step_v);
    clamped = clamped || std::abs(reachable_v - volts_v[i]) > kRounding_v;
    if (enabled(gate_rate)) volts_v[i] = reachable_v;
  }
  output.clamped = output.clamped || clamped;
  memory.rate_pressure = clamped ? memory.rate_pressure + kPressure : std::max(0, memory.rate_pressure - 1);
  if (memory.rate_pressure >= rate_pressure_limit(limits)) output.cause = Cause::demand_rate;
}

/// Sets `stale` and the cause after too many consecutive ticks without a usable demand.
void judge_freshness(const Limits& limits, GateMemory& memory, GateOutput& output) noexcept {
  output.stale = memory.missing_in_row >= limits.demand_stale_after_ticks;
  if (memory.invalid_in_row >= limits.demand_invalid_in_row) {
    output.cause = Cause::demand_invalid;
  } else if (output.stale) {
    output.cause = output.invalid ? Cause::demand_invalid : Cause::demand_stale;
  }
}

}  // namespace

int rate_pressure_limit(const Limits& limits) noexcept {
  double reversal_ticks = 0;
  for (const AxisLimits& axis : limits.axis) {
    if (!axis.present) continue;
    reversal_ticks =
        std::max(reversal_ticks, 2 * axis.volt_limit_v / (axis.volt_rate_limit_vps * limits.period_s));
  }
  constexpr double kMost_ticks = 1e6;
  return kPressure * (10 + static_cast<int>(std::min(std::ceil(reversal_ticks), kMost_ticks)));
}

namespace {
bool is_plausible(const Limits& limits, const PerAxis& demand_v) noexcept {
  for (std::size_t i = 0; i < kAxes; ++i)
    if (limits.axis[i].present && !(std::abs(demand_v[i]) <= kRejectionRatio * limits.axis[i].volt_limit_v))
      return false;
  return std::ranges::all_of(demand_v, [](double v) { return std::isfinite(v); });
}
}  // namespace

GateOutput gate(const Limits& limits, const GateInput& input, GateMemory& memory) noexcept {
  GateOutput output;
  const bool plausible = is_plausible(limits, input.demand_v);
  output.invalid = input.arrived && !plausible;
  const bool usable = input.arrived && plausible;
  memory.missing_in_row = usable ? 0 : std::min(memory.missing_in_row + 1, kCountEnd);
  memory.invalid_in_row = output.invalid ? std::min(memory.invalid_in_row + 1, kCountEnd) : 0;
  if (output.invalid) ++memory.rejected_count;
  if (!input.arrived) ++memory.missing_count;

  PerAxis volts_v = usable ? input.demand_v : memory.last_v;
  if (usable && enabled(gate_range)) limit_range(limits, volts_v, output);
  output.near_zero = usable && is_near_zero(limits, volts_v);
  if (usable && input.drives_active) limit_rate(limits, memory, volts_v, output);
  if (!input.drives_active) memory.rate_pressure = 0;
  judge_freshness(limits, memory, output);
  if (output.clamped) ++memory.clamped_count;
  if (!input.drives_active) return output;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (input.block_positive[i] && enabled(gate_block_outwards)) volts_v[i] = std::min(volts_v[i], 0.0);
    if (input.block_negative[i] && enabled(gate_block_outwards)) volts_v[i] = std::max(volts_v[i], 0.0);
  }
  output.drive_v = volts_v;
  return output;
}

}  // namespace crane::supervisor
