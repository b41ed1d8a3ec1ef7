#include "model/parameter.hpp"

#include <algorithm>
#include <cmath>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

double quantile(std::vector<double> v, double share) {
  if (v.empty()) return 0;
  const auto place = static_cast<std::size_t>(share * static_cast<double>(v.size() - 1));
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(place), v.end());
  return v[place];
}

/// Speeds over at least 50 ms and five rows, so that counts do not make them.
void add_speeds(const Series& s, std::vector<double>& speeds) {
  std::size_t from = 0;
  for (std::size_t k = 5; k < s.size(); ++k) {
    while (from + 6 <= k && s.time_s[k] - s.time_s[from + 1] >= 0.05) ++from;
    if (s.time_s[k] - s.time_s[from] < 0.5)
      speeds.push_back(std::abs(s.value[k] - s.value[from]) / (s.time_s[k] - s.time_s[from]));
  }
}

struct Range {
  double low = 0, high = 0;
};
Range range_of(const std::vector<Run>& runs, std::size_t channel) {
  std::vector<double> all;
  for (const Run& run : runs)
    all.insert(all.end(), run.measured[channel].value.begin(), run.measured[channel].value.end());
  return {quantile(all, 0.002), quantile(all, 0.998)};
}

void set_axis(ParameterTable& t, const configuration::Rig& rig, const Scales& s, std::size_t i) {
  const double u = s.volts[i], v = s.speed[i], travel = s.travel[i];
  const auto set = [&](AxisParameter p, double scale, double low, double high, double null = 0) {
    t[of_axis(i, p)] = {null, scale, low, high};
  };
  double least_dry = 0, least_viscous = 0;
  for (const auto& term : rig.terms)
    if (term.name == "drive_friction" && term.axis == kDriveNames[i]) {
      const auto get = [&](const char* name) {
        return term.parameters.contains(name) ? term.parameters.at(name) : 0.0;
      };
      least_dry = std::min(get("coulomb_positive_v"), get("coulomb_negative_v"));
      least_viscous = std::min(get("viscous_positive_vspm"), get("viscous_negative_vspm"));
    }
  set(kCoulomb, 0.05 * u, -least_dry, 5 * u);
  set(kViscous, 0.1 * u / v, -least_viscous, 20 * u / v);
  set(kAsymmetryDry, 0.05 * u, -2 * u, 2 * u);
  set(kAsymmetryViscous, 0.1 * u / v, -5 * u / v, 5 * u / v);
  set(kStribeck, 0.05 * u, 0, 5 * u);
  set(kStribeckSpeed, 0.05 * v, 0.01 * v, 0.6 * v, 0.15 * v);
  set(kTight, 0.05 * u, 0, 5 * u);
  set(kTightAt, 0.02 * travel, s.middle[i] - 2 * travel, s.middle[i] + 2 * travel, s.middle[i]);
  set(kTightWave, 0.02 * travel, 0.05 * travel, 3 * travel, 0.5 * travel);
  set(kRippleSine, 0.05 * u, -5 * u, 5 * u);
  set(kRippleCosine, 0.05 * u, -5 * u, 5 * u);
  set(kRippleWave, 1e-4 * travel, 2e-3 * travel, travel, 0.1 * travel);
  set(kTurnSine, 0.05 * u, -20 * u, 20 * u);
  set(kTurnCosine, 0.05 * u, -20 * u, 20 * u);
  set(kGain, 0.05, -0.8, 4);
  set(kOffset, 0.02 * u, -3 * u, 3 * u);
  set(kDeadZone, 0.05 * u, 0, 3 * u);
  set(kDelay, 0.01, 0, 0.4);
  set(kLag, 0.01, 0, 0.6);
  set(kSecondLag, 0.01, 0, 0.6);
  set(kLoadFriction, 0.05, 0, 0.95);
  set(kPositionScale, 0.01, -0.3, 0.3);
}

void set_load(ParameterTable& t, const Scales& s) {
  const auto set = [&](std::size_t p, double scale, double low, double high, double null = 0) {
    t[of_load(p)] = {null, scale, low, high};
  };
  const double m = s.load_kg, l = s.cable_m, w = s.omega_radps, rate = s.swing_rad * w;
  set(kMass, 0.1 * m, -0.8 * m, 5 * m);
  set(kCable, 0.01 * l, -0.6 * l, l);
  set(kLinearDrag, 0.02 * m * w, 0, 20 * m * w);
  set(kQuadraticDrag, 0.02 * m * w / std::max(rate * l, 1e-3), 0, 20 * m * w / std::max(rate * l, 1e-3));
  set(kWindAlong, 0.003 * s.load_n, -0.5 * s.load_n, 0.5 * s.load_n);
  set(kWindAcross, 0.003 * s.load_n, -0.5 * s.load_n, 0.5 * s.load_n);
  set(kTilt, 0.005, -0.3, 0.3);
  set(kLowerShare, 0.03, 0, 0.95);
  set(kLowerLength, 0.02 * l, 0.03 * l, 2 * l, 0.2 * l);
  set(kHookRaised, 0.02 * l, 0, 0.8 * l);
  for (std::size_t k = 0; k < 2; ++k) {
    set(kPivotViscous + k, 0.01 * m * l * l * w, 0, 5 * m * l * l * w);
    set(kPivotDry + k, 0.005 * s.load_n * l * s.swing_rad, 0, 0.5 * s.load_n * l * s.swing_rad);
    set(kSwingOffset + k, 0.003, -0.3, 0.3);
    set(kSwingScale + k, 0.02, -0.5, 1);
  }
  set(kMisalignment, 0.02, -0.6, 0.6);
  set(kSwingDelay, 0.01, 0, 0.4);
  set(kSwingAverage, 0.03, 0, 0.6);
}

void set_noise(ParameterTable& t, const Scales& s) {
  const double longest = std::log(rule::kMostCorrelation.value);
  for (std::size_t c = 0; c < kChannels; ++c) {
    t[of_noise(c, kLogForce)] = {-3, 0.3, -16, 6};
    t[of_noise(c, kLogCorrelation)] = {-1, 0.3, -5, longest};
    t[of_noise(c, kLogSensor)] = {std::log(std::max(s.floor[c], 1e-9)), 0.3, -25, 0};
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const double at = std::log(std::max(1e-6, 0.06 * s.speed[i]));
    t[standstill_of(i)] = {at, 0.4, at - 6, at + 6};
    t[command_noise_of(i)] = {-5, 0.4, -9, 1};
  }
}

}  // namespace

Scales scales_of(const configuration::Rig& rig, const std::vector<Run>& runs) {
  Scales s;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const Range range = range_of(runs, c);
    const double width = range.high - range.low;
    s.floor[c] = rule::kFloorShare.value * width;
    if (c >= 2) {
      s.swing_rad = std::max({s.swing_rad == 1 ? 0 : s.swing_rad, 0.5 * width, 1e-3});
      continue;
    }
    std::vector<double> speeds, volts;
    for (const Run& run : runs) {
      add_speeds(run.measured[c], speeds);
      for (const double u : run.command[c].value) volts.push_back(std::abs(u));
    }
    if (width > 0) s.travel[c] = width, s.middle[c] = 0.5 * (range.low + range.high);
    if (const double v = quantile(speeds, 0.98); v > 0) s.speed[c] = v;
    if (const double u = quantile(volts, 0.9); u > 0) s.volts[c] = u;
  }
  s.load_kg = std::max(rig.plant.load_mass_kg, 1e-6);
  s.load_n = s.load_kg * rig.plant.gravity_mps2;
  s.cable_m = rig.start.position[plant::kHoist];
  s.omega_radps = std::sqrt(rig.plant.gravity_mps2 / s.cable_m);
  return s;
}

ParameterTable parameter_table(const configuration::Rig& rig, const Scales& scales) {
  ParameterTable table{};
  for (std::size_t i = 0; i < 2; ++i) set_axis(table, rig, scales, i);
  set_load(table, scales);
  set_noise(table, scales);
  return table;
}

Values null_values(const ParameterTable& table) {
  Values values{};
  for (Index i = 0; i < kParameters; ++i) values[i] = table[i].null;
  return values;
}

}  // namespace crane::innovations
