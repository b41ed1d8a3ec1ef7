#include <algorithm>
#include <cmath>

#include "candidates/candidate.hpp"

namespace crane::innovations {
namespace {

class Library {
 public:
  explicit Library(const Problem& problem)
      : problem_(problem), layout_(layout_of(problem.rig, problem.runs, false)) {
    for (std::size_t c = 0; c < kChannels; ++c)
      measured_[c] = std::any_of(problem.runs.begin(), problem.runs.end(),
                                 [&](const Run& r) { return !r.measured[c].empty(); });
  }

  std::vector<Candidate> all() {
    for (std::size_t i = 0; i < 2; ++i)
      if (measured_[i] && layout_.volts[i]) add_drive(i);
    if (layout_.has(kPhi) || layout_.has(kTheta)) add_load();
    return std::move(all_);
  }

 private:
  void add(Candidate c) { all_.push_back(std::move(c)); }

  void add_drive(std::size_t i) {
    const double u = problem_.scales.volts[i], v = problem_.scales.speed[i];
    const auto of = [&](AxisParameter p) { return of_axis(i, p); };
    const auto drive = [&](const char* name, std::vector<Index> theta,
                           std::vector<std::vector<double>> starts = {}, bool quiet = false,
                           bool known = false, bool term = true) {
      add({name, kDriveNames[i], std::move(theta), std::move(starts), quiet, known, term, {i}});
    };
    const auto& friction = problem_.nominal.friction[i];
    const bool dry = friction.dry[0] + friction.dry[1] > 0,
               viscous = friction.viscous[0] + friction.viscous[1] > 0;
    drive("coulomb_friction", {of(kCoulomb)}, {}, true, dry);
    drive("viscous_friction", {of(kViscous)}, {}, false, viscous);
    drive("direction_asymmetry", {of(kAsymmetryDry), of(kAsymmetryViscous)}, {{0.05 * u, 0}, {-0.05 * u, 0}},
          true);
    drive("stribeck_friction", {of(kStribeck), of(kStribeckSpeed)}, {{0.1 * u, 0.1 * v}, {0.1 * u, 0.3 * v}},
          true);
    drive("position_dependent_friction", {of(kTight), of(kTightAt), of(kTightWave)});
    drive("torque_ripple", {of(kRippleSine), of(kRippleCosine), of(kRippleWave)});
    if (i == kSlew)
      drive("torque_of_turn", {of(kTurnSine), of(kTurnCosine)}, {{-0.1 * u, 0}, {0.1 * u, 0}}, true);
    drive("motor_gain", {of(kGain)}, {}, false, true);
    drive("command_offset", {of(kOffset)}, {{0.05 * u}, {-0.05 * u}}, true);
    drive("command_dead_zone", {of(kDeadZone)}, {{0.05 * u}, {0.15 * u}}, true);
    drive("command_delay", {of(kDelay)}, {{0.005}, {0.015}, {0.04}, {0.08}});
    drive("actuator_lag", {of(kLag), of(kSecondLag)}, {{0.01, 0.005}, {0.03, 0.015}, {0.08, 0.02}});
    if (!problem_.nominal.ripples[i].empty())
      drive("load_dependent_friction", {of(kLoadFriction)}, {{0.1}, {0.3}}, true, false, false);
    if (layout_.has(kPhi) || layout_.has(kTheta) || !problem_.nominal.ripples[i].empty())
      drive("position_scale", {of(kPositionScale)});
  }

  [[nodiscard]] std::vector<std::size_t> swings() const {
    std::vector<std::size_t> channels;
    for (std::size_t c = 2; c < kChannels; ++c)
      if (measured_[c]) channels.push_back(c);
    return channels;
  }

  void load(const char* name, std::vector<Index> theta, std::vector<std::vector<double>> starts = {},
            bool known = false, const char* axis = "") {
    add({name, axis, std::move(theta), std::move(starts), false, known, true, swings()});
  }

  void add_load() {
    const bool pushed = layout_.volts[0] || layout_.volts[1], moved = layout_.has(kX) || layout_.has(kGamma);
    const bool both = measured_[2] && measured_[3];
    if (pushed) load("payload_mass", {of_load(kMass)}, {}, true);
    load("cable_length", {of_load(kCable)}, {}, true);
    load("load_linear_drag", {of_load(kLinearDrag)});
    load("load_quadratic_drag", {of_load(kQuadraticDrag)});
    if (moved || both) {
      std::vector<Index> wind{of_load(kWindAlong)};
      if (layout_.has(kTheta)) wind.push_back(of_load(kWindAcross));
      load("steady_wind", wind);
    }
    add_pivots(both);
    if (layout_.has(kX) && layout_.volts[0]) load("jib_tilt", {of_load(kTilt)});
    add_double_pendulum();
    add_sensors(moved, both);
  }

  void add_pivots(bool both) {
    for (std::size_t k = 0; k < 2; ++k)
      if (measured_[2 + k] || (k == 0 && layout_.has(kPhi)))
        load("swing_pivot_friction", {of_load(kPivotDry + k), of_load(kPivotViscous + k)}, {}, false,
             kSwingNames[k]);
    if (both)
      load("swing_pivot_friction",
           {of_load(kPivotDry), of_load(kPivotViscous), of_load(kPivotDry + 1), of_load(kPivotViscous + 1)});
  }

  /// Slings whose fast mode spans a decade; the measured length ends at the hook or at the load.
  void add_double_pendulum() {
    if (problem_.base[of_load(kLowerShare)] > 0) return;
    if (!has_filter(layout_of(problem_.rig, problem_.runs, true).size)) return;
    const double l = problem_.scales.cable_m;
    std::vector<std::vector<double>> starts;
    for (const double share : {0.4, 0.75})
      for (const double sling : {0.08, 0.18, 0.35, 0.6})
        for (const double raised : {0.0, 1.0})
          starts.push_back({share, sling * l, std::min(raised * sling, 0.6) * l});
    Candidate c{"double_pendulum",
                "",
                {of_load(kLowerShare), of_load(kLowerLength), of_load(kHookRaised)},
                starts,
                true,
                false,
                true,
                swings()};
    add(std::move(c));
  }

  void add_sensors(bool moved, bool both) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (!measured_[2 + k]) continue;
      load("swing_offset", {of_load(kSwingOffset + k)}, {}, false, kSwingNames[k]);
      load("swing_scale", {of_load(kSwingScale + k)}, {}, false, kSwingNames[k]);
    }
    if (!moved) return;
    if (both) load("swing_misalignment", {of_load(kMisalignment)});
    if (!measured_[2] && !measured_[3]) return;
    load("swing_delay", {of_load(kSwingDelay)}, {{0.01}, {0.03}, {0.08}});
    load("swing_moving_average", {of_load(kSwingAverage)}, {{0.06}, {0.15}});
  }

  const Problem& problem_;
  Layout layout_;
  std::array<bool, kChannels> measured_{};
  std::vector<Candidate> all_;
};

}  // namespace

std::vector<Candidate> candidates_for(const Problem& problem) { return Library{problem}.all(); }

}  // namespace crane::innovations
