#pragma once
/// A crane with adaptive friction compensation, without processes and bus: model with terms, encoders,
/// converter, filters of the bridge, one tick of delay, laws, and consecutive moves.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "crane/control/adaptation.hpp"
#include "crane/control/filters.hpp"
#include "crane/control/friction_compensation.hpp"
#include "crane/control/pendulum_observer.hpp"
#include "crane/control/reference_start.hpp"
#include "crane/control/trajectory.hpp"
#include "crane/plant/model.hpp"

namespace crane::control::test {

struct AdaptedRig {
  Design design;                                   ///< what the controllers know
  plant::Parameters truth;                         ///< of the true crane
  std::array<DriveFriction, kAxes> true_friction;  ///< stiction: break-away level
  double cable_offset_m = 0;                       ///< true minus measured cable length
  std::array<double, 2> swing_offset_rad{};        ///< of the encoders
  std::vector<plant::TermSetting> more_terms;      ///< wind, ripple ...
  std::array<double, 5> counts{629921.26, 57295.78, 160000, 3819.72, 3819.72};
  double noise_counts = 0;  ///< standard deviation of every reading
  bool slews = true;
  const char* controller = "gain_scheduling_partial";
};

inline AdaptedRig adapted_tower() {
  AdaptedRig rig;
  rig.design.friction[kTrolley] = {1.5, 6.0, 0.9, 1.2, 0.9, 1.2, 100, 0.005, 1};
  rig.design.friction[kSlew] = {0.15, 0.05, 0.7, 0.6, 0.7, 0.6, 100, 0.005, 1};
  rig.design.adaptation.enabled = true;
  rig.truth = rig.design.crane;
  rig.true_friction = rig.design.friction;
  return rig;
}

/// deploy/rigs/gantry.toml with friction.
inline AdaptedRig adapted_gantry() {
  AdaptedRig rig;
  rig.design.crane.trolley_inertia_kg = 12;
  rig.design.crane.trolley_mass_kg = 4;
  rig.design.crane.load_mass_kg = 3;
  rig.design.crane.trolley_gain_mps2pv = 1.2;
  rig.design.cable_length_m = 1.5;
  rig.design.friction[kTrolley] = {0.8, 1.2, 0.6, 0.8, 0.6, 0.8, 100, 0.005, 1};
  rig.design.adaptation.enabled = true;
  rig.truth = rig.design.crane;
  rig.true_friction = rig.design.friction;
  rig.counts = {40000, 57295.78, 40000, 2607.6, 2607.6};
  rig.slews = false;
  return rig;
}

struct Target {
  double trolley_m = 0, slew_rad = 0;
};

struct MoveResult {
  double settled_s = 0;    ///< from the request; the length of the window: not settled
  double late_speed = 0;   ///< largest speed of an axis in the last 4 s, m/s or rad/s
  double late_travel = 0;  ///< sum of |displacement| of the worse axis in the last 4 s, m or rad
  int late_reversals = 0;  ///< of the worse axis in the last 4 s, beyond 1 mm/s or 1 mrad/s
};

class AdaptedCrane {
 public:
  explicit AdaptedCrane(const AdaptedRig& rig, unsigned seed = 1)
      : rig_{rig},
        random_{seed},
        controller_{*find_controller(rig.controller)},
        adaptation_{rig.design},
        tracking_{tracking_law(controller_, rig.design)},
        anti_swing_{anti_swing_law(controller_, rig.design)} {
    rebuild();
    for (std::size_t i = 0; i < 5; ++i)
      low_pass_[i] = i >= kAxes || i == kSlew ? butterworth_low_pass(0.05) : FilterSection{};
  }

  void place(double trolley_m, double slew_rad, double cable_m) {
    state_ = {};
    state_.trolley_m = trolley_m;
    state_.slew_rad = slew_rad;
    state_.cable_m = cable_m + rig_.cable_offset_m;
    cable_m_ = cable_m;
    target_ = {trolley_m, slew_rad};
    measured_ = read(true);
    tracking_->reset(measured_);
    anti_swing_->reset(measured_);
  }
  /// Changes friction, payload or wind of the true crane.
  void change(const std::function<void(AdaptedRig&)>& change_rig) {
    change_rig(rig_);
    rebuild();
  }
  void kick(double radial_radps, double tangential_radps) {
    state_.radial_radps += radial_radps;
    state_.tangential_radps += tangential_radps;
  }
  MoveResult move(const Target& target, double window_s = 10);
  [[nodiscard]] const Adaptation& adaptation() const { return adaptation_; }
  [[nodiscard]] const plant::State& state() const { return state_; }
  std::function<void(double)> watch;  ///< called once per tick with the time of the move

 private:
  void rebuild();
  [[nodiscard]] Measurement read(bool first);
  void tick(const Reference& reference);
  void advance(const Volts& volts);

  AdaptedRig rig_;
  std::mt19937 random_;
  const Controller& controller_;
  Adaptation adaptation_;
  std::unique_ptr<Law> tracking_, anti_swing_;
  std::optional<plant::Model> model_;
  plant::State state_;
  double cable_m_ = 1;
  Target target_;
  Measurement measured_;
  Volts volts_{}, demand_{};
  std::array<FilterSection, 5> low_pass_;
  std::array<FilterMemory, 5> low_memory_, rate_memory_;
  FilterSection differentiator_ = al_alaoui_second_order(100);
  bool started_ = false;
};

inline void AdaptedCrane::rebuild() {
  std::vector<plant::TermSetting> terms = rig_.more_terms;
  const auto add = [&](const char* axis, const DriveFriction& f) {
    terms.push_back({"drive_friction",
                     axis,
                     {{"viscous_positive_vspm", f.viscous_positive_vspm},
                      {"viscous_negative_vspm", f.viscous_negative_vspm},
                      {"coulomb_positive_v", f.coulomb_positive_v},
                      {"coulomb_negative_v", f.coulomb_negative_v},
                      {"stiction_positive_v", f.stiction_positive_v},
                      {"stiction_negative_v", f.stiction_negative_v},
                      {"stiction_speed", 0.005},
                      {"smoothing_speed", 0.0005}}});
  };
  add("trolley", rig_.true_friction[kTrolley]);
  if (rig_.slews) add("slew", rig_.true_friction[kSlew]);
  model_.emplace(rig_.truth, terms, rig_.design.period_s);
}

inline Measurement AdaptedCrane::read(bool first) {
  std::normal_distribution<double> normal{0, 1};
  const std::array<double, 5> values{state_.trolley_m, state_.slew_rad, cable_m_,
                                     state_.radial_rad + rig_.swing_offset_rad[0],
                                     state_.tangential_rad + rig_.swing_offset_rad[1]};
  std::array<double, 5> read{}, rate{};
  for (std::size_t i = 0; i < 5; ++i) {
    const double noise = rig_.noise_counts > 0 ? rig_.noise_counts * normal(random_) : 0;
    read[i] = std::round(values[i] * rig_.counts[i] + noise) / rig_.counts[i];
    if (first)
      low_memory_[i] = settled(low_pass_[i], read[i]), rate_memory_[i] = settled(differentiator_, read[i]);
    rate[i] = step(differentiator_, rate_memory_[i], step(low_pass_[i], low_memory_[i], read[i]));
  }
  return {
      {read[0], read[1], read[2]}, {rate[0], rate[1], rate[2]}, read[3], rate[3], read[4], rate[4], volts_};
}

inline void AdaptedCrane::advance(const Volts& volts) {
  constexpr int kSteps = 50;
  const double h = rig_.design.period_s / kSteps;
  plant::Actuation actuation;
  actuation.drive_v = model_->drive_voltage(volts);
  actuation.locks.axis[kHoist] = true;
  if (!rig_.slews) actuation.locks.axis[kSlew] = actuation.locks.tangential = true;
  const auto rate = [&](const plant::State& s) {
    const auto a = model_->accelerations(s, actuation);
    return plant::StateArray{s.trolley_mps,  s.radial_radps,  s.slew_radps,  s.tangential_radps,  0,
                             a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, 0};
  };
  const auto moved = [](const plant::State& at, const plant::StateArray& by, double time_s) {
    auto values = plant::to_array(at);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += time_s * by[i];
    return plant::to_state(values);
  };
  model_->begin_tick();
  for (int i = 0; i < kSteps; ++i) state_ = moved(state_, rate(moved(state_, rate(state_), h / 2)), h);
}

inline void AdaptedCrane::tick(const Reference& reference) {
  measured_ = read(false);
  adaptation_.step({.measured = measured_, .demand_v = demand_, .brake_closed = {}, .consecutive = started_});
  started_ = true;
  const auto swing_part = anti_swing_->step(measured_, reference);
  Reference corrected = reference;
  for (std::size_t i = 0; i < kAxes; ++i) {
    corrected[i].position += swing_part.correction[i].position;
    corrected[i].speed += swing_part.correction[i].speed;
  }
  const auto tracking = tracking_->step(measured_, corrected);
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double control_v = tracking.drive_v[i] + swing_part.drive_v[i];
    demand_[i] =
        control_v + friction_compensation_v(adaptation_.friction()[i], control_v, measured_.speed[i]);
  }
  demand_[kHoist] = 0;
  if (!rig_.slews) demand_[kSlew] = 0;
  advance(volts_);  // the command of the tick before acts
  for (std::size_t i = 0; i < kAxes; ++i) {
    constexpr double kCode_v = 20.0 / 8192;
    volts_[i] = std::round(std::clamp(demand_[i], -10.0, 10.0) / kCode_v) * kCode_v;
  }
}

inline MoveResult AdaptedCrane::move(const Target& target, double window_s) {
  const auto plan = [&](double from, double to, double speed, double acceleration) {
    if (controller_.reference == ReferenceShape::step) return step_profile(from, to);
    return limited_profile(from, to, {speed, acceleration, 0});
  };
  const Trajectory wanted{plan(target_.trolley_m, target.trolley_m, 0.4982, 0.9929),
                          plan(target_.slew_rad, target.slew_rad, 1.0435, 2.0796),
                          step_profile(cable_m_, cable_m_)};
  target_ = target;
  ReferenceStart start;
  MoveResult result;
  const int ticks = static_cast<int>(std::lround(window_s / rig_.design.period_s));
  std::array<int, 2> side{}, reversals{};
  plant::State before = state_;
  std::array<double, 2> travel{};
  for (int k = 0; k < ticks; ++k) {
    const double t = k * rig_.design.period_s;
    Reference reference = reference_at(wanted, t);
    start.set_starts(measured_, reference);
    tick(reference);
    if (watch) watch(t);
    const bool settled =
        std::abs(state_.trolley_m - target.trolley_m) < 0.02 * 0.75 &&
        (!rig_.slews || std::abs(state_.slew_rad - target.slew_rad) < 0.02 * std::numbers::pi / 2) &&
        std::max(std::abs(state_.radial_rad), std::abs(state_.tangential_rad)) < 0.5 * std::numbers::pi / 180;
    if (!settled) result.settled_s = t + rig_.design.period_s;
    if (t > window_s - 4) {
      const std::array speed{state_.trolley_mps, state_.slew_radps};
      travel[0] += std::abs(state_.trolley_m - before.trolley_m);
      travel[1] += std::abs(state_.slew_rad - before.slew_rad);
      for (std::size_t i = 0; i < 2; ++i) {
        result.late_speed = std::max(result.late_speed, std::abs(speed[i]));
        const int now = speed[i] > 1e-3 ? 1 : speed[i] < -1e-3 ? -1 : 0;
        if (now != 0 && now != side[i]) reversals[i] += side[i] != 0, side[i] = now;
      }
    }
    before = state_;
  }
  result.late_reversals = std::max(reversals[0], reversals[1]);
  result.late_travel = std::max(travel[0], travel[1]);
  return result;
}

}  // namespace crane::control::test
