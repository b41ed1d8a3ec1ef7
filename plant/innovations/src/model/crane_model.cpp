#include "model/crane_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Below this share of the drive's volts dry friction is a smooth sign: its set-valued law divides by it.
constexpr double kHardlyDry = 0.002;

}  // namespace

CraneModel::CraneModel(const Nominal& nominal, const Layout& which, const Values& values,
                       const Scales& scales)
    : layout(which), nominal_(nominal), p_(values), plant_(nominal.plant), cable_m_(nominal.cable_m) {
  if (plant_.load_mass_kg > 0)
    plant_.load_mass_kg =
        std::max(plant_.load_mass_kg + p_[of_load(kMass)], 0.05 * nominal.plant.load_mass_kg);
  if (!layout.has(kPhi) && !layout.has(kTheta)) plant_.load_mass_kg = 0;
  if (layout.lower[0] != kNone || layout.lower[1] != kNone) {
    lower_kg_ = p_[of_load(kLowerShare)] * plant_.load_mass_kg;
    lower_m_ = std::max(p_[of_load(kLowerLength)], 1e-3);
    plant_.load_mass_kg -= lower_kg_;
  }
  locks_.axis = {!layout.volts[0], !layout.volts[1], true};
  locks_.radial = !layout.has(kPhi), locks_.tangential = !layout.has(kTheta);
  per_volt_ = {plant_.trolley_inertia_kg * plant_.trolley_gain_mps2pv,
               plant_.jib_inertia_kgm2 * plant_.slew_gain_radps2pv};
  for (std::size_t c = 0; c < 4; ++c)
    forgetting_[c] = std::exp(-p_[of_noise(kChannelOf[c], kLogCorrelation)]);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& dry = nominal_.friction[i].dry;
    rubs_[i] = layout.volts[i] && (dry[0] + dry[1] > 0 || p_[of_axis(i, kCoulomb)] != 0 ||
                                   p_[of_axis(i, kAsymmetryDry)] != 0 || p_[of_axis(i, kStribeck)] > 0 ||
                                   p_[of_axis(i, kTight)] > 0 || p_[of_axis(i, kLoadFriction)] > 0);
  }
  pivot_soft_ = 0.01 * scales.swing_rad * scales.omega_radps;
}

plant::State CraneModel::state_of(const double* s) const {
  plant::State state;
  state.cable_m = std::max(0.05 * nominal_.cable_m, cable_m_ + p_[of_load(kCable)]);
  if (lower_kg_ > 0)
    state.cable_m = std::max(0.05 * nominal_.cable_m, state.cable_m - p_[of_load(kHookRaised)]);
  state.cable_mps = cable_mps_;
  if (const std::size_t b = layout.begin[kX]; b != kNone)
    state.trolley_m = s[b], state.trolley_mps = s[b + 1];
  if (const std::size_t b = layout.begin[kPhi]; b != kNone)
    state.radial_rad = s[b], state.radial_radps = s[b + 1];
  if (const std::size_t b = layout.begin[kGamma]; b != kNone)
    state.slew_rad = s[b], state.slew_radps = s[b + 1];
  if (const std::size_t b = layout.begin[kTheta]; b != kNone)
    state.tangential_rad = s[b], state.tangential_radps = s[b + 1];
  return state;
}

double CraneModel::turn_volts(std::size_t i, double q) const {
  double volts = p_[of_axis(i, kTurnSine)] * std::sin(q) + p_[of_axis(i, kTurnCosine)] * std::cos(q);
  for (const auto& ripple : nominal_.ripples[i])
    volts += ripple.amplitude_v * std::sin(ripple.wave_number * q + ripple.phase_rad);
  return volts;
}

/// Everything of the axis itself but dry friction, in volts towards +.
double CraneModel::smooth_volts(std::size_t i, double q, double v) const {
  const auto& f = nominal_.friction[i];
  double volts =
      -(f.viscous[v < 0] + p_[of_axis(i, kViscous)]) * v - p_[of_axis(i, kAsymmetryViscous)] * std::abs(v);
  const double sine = p_[of_axis(i, kRippleSine)], cosine = p_[of_axis(i, kRippleCosine)];
  if (sine != 0 || cosine != 0) {
    const double angle = kTurn * q / p_[of_axis(i, kRippleWave)];
    volts += sine * std::sin(angle) + cosine * std::cos(angle);
  }
  return volts + turn_volts(i, q);
}

double CraneModel::dry_friction_v(std::size_t i, double q, double v, double applied, double carried,
                                  double soft) const {
  const auto& f = nominal_.friction[i];
  const auto at = [&](AxisParameter p) { return p_[of_axis(i, p)]; };
  double common = at(kCoulomb) + at(kLoadFriction) * std::abs(carried);
  if (at(kStribeck) > 0) common += at(kStribeck) * std::exp(-std::pow(v / at(kStribeckSpeed), 2));
  if (at(kTight) > 0)
    common += 0.5 * at(kTight) * (1 + std::cos(kTurn * (q - at(kTightAt)) / at(kTightWave)));
  const double decay = f.excess[0] + f.excess[1] > 0 ? std::exp(-std::pow(v / f.excess_speed, 2)) : 0;
  const auto level = [&](std::size_t side) {
    return common + f.dry[side] + f.excess[side] * decay + (side == 0 ? 1 : -1) * at(kAsymmetryDry);
  };
  const double mean = 0.5 * (level(0) + level(1)), hardly = kHardlyDry * std::max(1.0, f.dry[0]);
  if (mean < hardly) return level(v < 0) * std::tanh(v / soft);
  const double share = std::clamp(applied / mean + v / soft, -1.5, 1.5),
               most = std::max(level(share < 0), hardly);
  return std::clamp(share * mean, -most, most);
}

/// Unknown force, drag, wind and tilted gravity on the load, in the jib's frame [N].
Eigen::Vector3d CraneModel::load_force(const double* s, const plant::State& state) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  if (layout.has(kPhi)) force.x() = s[layout.begin[kPhi] + 2];
  if (layout.has(kTheta)) force.y() = s[layout.begin[kTheta] + 2];
  const double linear = p_[of_load(kLinearDrag)], quadratic = p_[of_load(kQuadraticDrag)];
  if (linear != 0 || quadratic != 0) {
    const Eigen::Vector3d v = plant::load_velocity_mps(state);
    force -= (linear + quadratic * v.norm()) * v;
  }
  if (const double along = p_[of_load(kWindAlong)], across = p_[of_load(kWindAcross)];
      along != 0 || across != 0) {
    const double c = std::cos(state.slew_rad), n = std::sin(state.slew_rad);
    force.x() += along * c + across * n;
    force.y() += across * c - along * n;
  }
  return force;
}

void CraneModel::rub(const double* s, const plant::State& state, const std::array<double, 2>& volts,
                     const std::array<double, 2>& soft, plant::Accelerations& a) const {
  if (!rubs_[0] && !rubs_[1]) return;
  const auto response = plant::drive_response(plant_, state, locks_);
  const std::array<double, 2> own{response.trolley_mps2_pn, response.slew_radps2_pnm};
  const std::array<double, 2> free{a.trolley_mps2, a.slew_radps2};
  std::array<double, 2> force{};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!rubs_[i]) continue;
    const std::size_t b = layout.begin[i == 0 ? kX : kGamma];
    const double carried = p_[of_axis(i, kLoadFriction)] > 0
                               ? volts[i] - s[b + 1] * nominal_.friction[i].viscous[0] - turn_volts(i, s[b])
                               : 0;
    force[i] = -per_volt_[i] *
               dry_friction_v(i, s[b], s[b + 1], free[i] / (own[i] * per_volt_[i]), carried, soft[i]);
  }
  const double x = own[0] * force[0] + response.coupling * force[1];
  const double gamma = own[1] * force[1] + response.coupling * force[0];
  const auto swing = plant::swing_response(plant_, state, x, gamma, locks_);
  a.trolley_mps2 += x, a.slew_radps2 += gamma;
  a.radial_radps2 += swing.radial_radps2, a.tangential_radps2 += swing.tangential_radps2;
}

/// Tension of the lower cable on the hook. In a plane it is exact: along e2, from hook to load,
///   m2 (a_hook e2 - l w2^2) = m2 g e2 + F e2 - T,   a_hook = a_0 + T b
/// In space it is that of small angles, m2 g, as the term of plant/model has it.
void CraneModel::lower_cable(const double* s, const plant::State& state, const Eigen::Vector3d& force,
                             plant::Forces& sum, double*) const {
  const double g = plant_.gravity_mps2;
  const auto angle = [&](std::size_t k) { return layout.lower[k] == kNone ? 0.0 : s[layout.lower[k]]; };
  const double f = angle(0), t = angle(1);
  const Eigen::Vector3d e2{-std::cos(t) * std::sin(f), std::sin(t), -std::cos(t) * std::cos(f)};
  const auto pull = [&](double tension, plant::Forces& on) {
    const Eigen::Vector4d q = plant::load_jacobian(state).transpose() * (tension * e2);
    on.trolley_n += q[0], on.radial_nm += q[1], on.slew_nm += q[2], on.tangential_nm += q[3];
  };
  double tension = lower_kg_ * g;
  if (layout.planar()) {
    const auto hook = [&](double n) {
      plant::Forces with = sum;
      pull(n, with);
      const auto a = plant::accelerations(plant_, state, with, 0, locks_);
      const double l = state.cable_m, sf = std::sin(state.radial_rad), cf = std::cos(state.radial_rad);
      const double w = state.radial_radps;
      return Eigen::Vector3d{a.trolley_mps2 - l * cf * a.radial_radps2 + l * sf * w * w, 0,
                             l * sf * a.radial_radps2 + l * cf * w * w};
    };
    const double a0 = hook(0).dot(e2), b = hook(1).dot(e2) - a0, w2 = s[layout.lower[0] + 1];
    const double gravity = -g * e2.z();
    tension = (lower_kg_ * (gravity - a0 + lower_m_ * w2 * w2) + force.dot(e2)) / (1 + lower_kg_ * b);
  }
  pull(tension, sum);
}

/// l w2' = (g + F / m2 - a_hook) across the lower cable.
void CraneModel::add_lower_rates(const double* s, const plant::State& state, const plant::Accelerations& a,
                                 double* r) const {
  const double g = plant_.gravity_mps2, l = state.cable_m, ratio = lower_kg_ / plant_.load_mass_kg;
  if (layout.planar()) {
    const std::size_t b = layout.lower[0];
    const double f2 = s[b], sf = std::sin(state.radial_rad), cf = std::cos(state.radial_rad),
                 w = state.radial_radps;
    const double ax = a.trolley_mps2 - l * cf * a.radial_radps2 + l * sf * w * w;
    const double az = l * sf * a.radial_radps2 + l * cf * w * w;
    const Eigen::Vector3d force = load_force(s, state);
    r[b] = s[b + 1];
    r[b + 1] =
        (-(force.x() / lower_kg_ - ax) * std::cos(f2) + (force.z() / lower_kg_ - g - az) * std::sin(f2)) /
        lower_m_;
    return;
  }
  const std::array<double, 2> upper{state.radial_rad, state.tangential_rad};
  for (std::size_t k = 0; k < 2; ++k)
    if (const std::size_t b = layout.lower[k]; b != kNone) {
      r[b] = s[b + 1];
      r[b + 1] = g / lower_m_ * (1 + ratio) * (std::sin(upper[k]) - std::sin(s[b]));
    }
}

void CraneModel::rate(const double* s, const std::array<double, 2>& volts, const std::array<double, 2>& soft,
                      double* r) const {
  const plant::State state = state_of(s);
  plant::Forces sum;
  plant::Locks locks = locks_;
  std::array<double, 2> pushed{};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t b = layout.begin[i == 0 ? kX : kGamma];
    if (b == kNone) continue;
    if (!layout.volts[i]) {
      locks.acceleration[i] = s[b + 2];
      continue;
    }
    pushed[i] = volts[i] + s[b + 2];
    (i == 0 ? sum.trolley_n : sum.slew_nm) = per_volt_[i] * (pushed[i] + smooth_volts(i, s[b], s[b + 1]));
  }
  if (plant_.load_mass_kg > 0) {
    const Eigen::Vector3d force = load_force(s, state);
    Eigen::Vector3d on_hook = lower_kg_ > 0 && layout.planar() ? Eigen::Vector3d::Zero() : force;
    if (const double tilt = p_[of_load(kTilt)]; tilt != 0) {
      const double g = plant_.gravity_mps2;
      sum.trolley_n -= plant_.trolley_mass_kg * g * std::sin(tilt);
      on_hook += plant_.load_mass_kg * g * Eigen::Vector3d{-std::sin(tilt), 0, 1 - std::cos(tilt)};
    }
    const Eigen::Vector4d q = plant::load_jacobian(state).transpose() * on_hook;
    const auto pivot = [&](std::size_t k, double w) {
      return p_[of_load(kPivotViscous + k)] * w + p_[of_load(kPivotDry + k)] * std::tanh(w / pivot_soft_);
    };
    sum.trolley_n += q[0], sum.slew_nm += q[2];
    sum.radial_nm += q[1] - pivot(0, state.radial_radps);
    sum.tangential_nm += q[3] - pivot(1, state.tangential_radps);
    if (lower_kg_ > 0) lower_cable(s, state, force, sum, r);
  }
  plant::Accelerations a = plant::accelerations(plant_, state, sum, 0, locks);
  rub(s, state, pushed, soft, a);
  const std::array<double, 4> acceleration{a.trolley_mps2, a.radial_radps2, a.slew_radps2,
                                           a.tangential_radps2};
  for (std::size_t c = 0; c < 4; ++c)
    if (const std::size_t b = layout.begin[c]; b != kNone)
      r[b] = s[b + 1], r[b + 1] = acceleration[c], r[b + 2] = -forgetting_[c] * s[b + 2];
  if (lower_kg_ > 0) add_lower_rates(s, state, a, r);
}

}  // namespace crane::innovations
