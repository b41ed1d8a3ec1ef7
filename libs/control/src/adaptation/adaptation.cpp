#include "crane/control/adaptation.hpp"

#include <algorithm>
#include <cmath>

#include "adaptation/axis_adaptation.hpp"
#include "adaptation/load_estimate.hpp"
#include "crane/control/schedule.hpp"

namespace crane::control {
namespace {

using adaptation::AxisAdaptation;

constexpr double kExecuted_v = 0.01;  // above the rounding of the analog output: 2.5 mV at 13 bit and 10 V
constexpr double kModelledSwing_rad = 0.35;  // 20 deg; larger swing has effects outside the force balance
constexpr double kHoistingMean_s = 0.1;      // time constant of the mean cable speed
constexpr double kHoisting_mps = 0.01;       // largest mean cable speed that counts as rest
constexpr double kRestAfterMove_s = 0.5;

bool is_finite(const AdaptationInput& input) noexcept {
  const Measurement& m = input.measured;
  double sum = m.swing_radial_rad + m.swing_tangential_rad;
  for (std::size_t i = 0; i < kAxes; ++i)
    sum += m.position[i] + m.speed[i] + m.applied_v[i] + input.demand_v[i];
  return std::isfinite(sum);
}

}  // namespace

struct Adaptation::Memory {
  explicit Memory(const Design& given)
      : design{given},
        friction{given.friction},
        filter{given},
        balance{given},
        load{given},
        axis{AxisAdaptation{given, kTrolley}, AxisAdaptation{given, kSlew}} {}

  [[nodiscard]] AdaptationFreeze reason(const AdaptationInput& input, std::size_t i) const noexcept {
    const double limit = design.volt_limit_v[i], demand = input.demand_v[i];
    const Measurement& m = input.measured;
    if (!input.consecutive) return AdaptationFreeze::gap;
    if (input.brake_closed[i]) return AdaptationFreeze::brake;
    if (std::abs(m.applied_v[i] - std::clamp(demand, -limit, limit)) > kExecuted_v)
      return AdaptationFreeze::not_executed;
    if (std::abs(demand) >= limit) return AdaptationFreeze::saturation;
    if (std::max(std::abs(m.swing_radial_rad), std::abs(m.swing_tangential_rad)) > kModelledSwing_rad)
      return AdaptationFreeze::swing;
    if (std::abs(hoisting_mps) > kHoisting_mps) return AdaptationFreeze::hoist;
    return AdaptationFreeze::none;
  }

  void step(const AdaptationInput& input) noexcept {
    const bool usable = is_finite(input);
    if (usable)
      hoisting_mps += (input.measured.speed[kHoist] - hoisting_mps) * design.period_s / kHoistingMean_s;
    if (!usable || !input.consecutive) balance.reset(), load.reset();
    const bool known = usable && balance.step(input.measured);
    if (usable) load.step(input.measured);
    bool moves = false;
    for (std::size_t i = 0; i < kAdaptedAxes; ++i) {
      const auto why = usable ? reason(input, i) : AdaptationFreeze::gap;
      axis[i].step(known ? &balance.balance()[i] : nullptr, why, filter);
      moves = moves || axis[i].moves();
    }
    note_motion(moves);
    publish();
  }

  /// A move ends when all axes have rested for kRestAfterMove_s.
  void note_motion(bool moves) noexcept {
    rest_s = moves ? 0 : rest_s + design.period_s;
    moved = moved || moves;
    if (!moved || rest_s < kRestAfterMove_s) return;
    moved = false;
    ++report.moves;
    for (auto& each : axis) each.end_move(filter);
    filter.loosen_payload();
  }

  void publish() noexcept {
    for (std::size_t i = 0; i < kAdaptedAxes; ++i) {
      report.axis[i] = axis[i].report();
      if (axis[i].adapts()) friction[i] = axis[i].friction();
      report.swing_offset_rad[i] = load.offset_rad(i);
    }
    report.load_mass_kg = filter.load_mass_kg();
    report.pendulum_length_m = load.length_m();
  }

  Design design;
  std::array<DriveFriction, kAxes> friction;
  adaptation::LevelFilter filter;
  adaptation::ForceBalance balance;
  adaptation::LoadEstimate load;
  std::array<AxisAdaptation, kAdaptedAxes> axis;
  AdaptationReport report;
  double rest_s = 0, hoisting_mps = 0;
  bool moved = false;
};

Adaptation::Adaptation(const Design& design) : memory_{std::make_unique<Memory>(design)} {}
Adaptation::~Adaptation() = default;
Adaptation::Adaptation(Adaptation&&) noexcept = default;
Adaptation& Adaptation::operator=(Adaptation&&) noexcept = default;

void Adaptation::step(const AdaptationInput& input) noexcept {
  AdaptationInput limited = input;
  limited.measured = bounded(input.measured);
  memory_->step(limited);
}

const std::array<DriveFriction, kAxes>& Adaptation::friction() const noexcept { return memory_->friction; }
const AdaptationReport& Adaptation::report() const noexcept { return memory_->report; }

}  // namespace crane::control
