#pragma once
/// A trolley with a hanging load, by itself: Runge-Kutta 4 at 0.5 ms, bristle friction (LuGre), coloured
/// disturbances. Shares nothing with the project.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace crane::innovations::test {

struct SampleCrane {
  double inertia_kg = 10, load_kg = 0, gain = 1.7, cable_m = 1.2;
  double coulomb_v = 0.8, viscous_vs = 3, delay_s = 0, swing_delay_s = 0;
  double disturbance_v = 0.03, disturbance_n = 0.01;
  double position_step_m = 2e-6, swing_step_rad = 3e-4;
};

struct SampleRows {
  std::vector<double> time_s, volts, position_m, swing_rad;
};

class SampleRun {
 public:
  SampleRun(const SampleCrane& crane, unsigned seed) : c_(crane), random_(seed) {
    std::uniform_real_distribution<double> phase{0, 6.28};
    for (const double hz : {0.11, 0.23, 0.47, 0.9, 1.6}) tones_.push_back({hz, phase(random_)});
  }

  /// Closed loop on a sum of tones, sampled each 10 ms.
  SampleRows rows(double seconds) {
    SampleRows all;
    for (int k = 0; k < static_cast<int>(seconds * 100); ++k) {
      const double t = 0.01 * k;
      all.time_s.push_back(t);
      all.volts.push_back(volts_);
      all.position_m.push_back(rounded(s_[0], c_.position_step_m));
      all.swing_rad.push_back(rounded(swing_before(c_.swing_delay_s), c_.swing_step_rad));
      past_volts_.push_back(volts_);
      for (int i = 0; i < 20; ++i) advance(t + 0.0005 * i);
      volts_ = std::clamp(40 * (reference(t) - s_[0]) - 8 * s_[1] + 4 * s_[1], -8.0, 8.0);
    }
    return all;
  }

 private:
  struct Tone {
    double hz, phase;
  };
  using S = std::array<double, 5>;  // x, v, swing, rate, bristle

  double reference(double t) const {
    double r = 0;
    for (const Tone& tone : tones_)
      r += 0.06 / (1 + 6 * tone.hz) * std::sin(6.2832 * tone.hz * t + tone.phase);
    return r;
  }
  double rounded(double v, double step) {
    std::normal_distribution<double> noise{0, 0.3 * step};
    return step * std::round((v + noise(random_)) / step);
  }
  double swing_before(double delay_s) const {
    const auto back = static_cast<std::size_t>(std::lround(delay_s / 0.0005));
    return back < swings_.size() ? swings_[swings_.size() - 1 - back] : 0;
  }
  S rate(const S& s, double volts) const {
    constexpr double kBristle = 2e-5;
    const double z = s[4], v = s[1], level = std::max(c_.coulomb_v, 1e-9);
    const double z_rate = v - std::abs(v) * z / kBristle;
    const double friction = level * z / kBristle + c_.viscous_vs * v;
    const double force = c_.inertia_kg * c_.gain * (volts + drive_ - friction), m = c_.load_kg,
                 l = c_.cable_m;
    const double sn = std::sin(s[2]), cs = std::cos(s[2]);
    // (M + m) x'' - m l p'' cos p + m l p'^2 sin p = F; l p'' + g sin p - x'' cos p = Fx / -m cos p
    const double swing0 = -9.81 * sn - (m > 0 ? load_ / m * cs : 0);
    const double a =
        (force + load_ + m * cs * swing0 - m * l * s[3] * s[3] * sn) / (c_.inertia_kg + m * sn * sn);
    return {v, a, s[3], (swing0 + a * cs) / l, z_rate};
  }
  void advance(double t) {
    const double h = 0.0005;
    std::normal_distribution<double> unit;
    const double keep = std::exp(-h / 0.5), push = std::sqrt(1 - keep * keep);
    drive_ = keep * drive_ + push * c_.disturbance_v * unit(random_);
    load_ = c_.load_kg > 0 ? keep * load_ + push * c_.disturbance_n * unit(random_) : 0;
    const int k = static_cast<int>(std::floor((t - c_.delay_s) / 0.01 + 1e-6));
    const double volts = k >= 0 ? past_volts_[static_cast<std::size_t>(k)] : 0;
    const auto moved = [&](const S& r, double w) {
      S q = s_;
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += w * r[i];
      return q;
    };
    // the bristle is stiff: it follows exactly for the step's speed
    const S k1 = rate(s_, volts), k2 = rate(moved(k1, h / 2), volts), k3 = rate(moved(k2, h / 2), volts),
            k4 = rate(moved(k3, h), volts);
    const double z = s_[4], v = s_[1];
    for (std::size_t i = 0; i < 4; ++i) s_[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    const double fade = std::exp(-std::abs(v) * h / 2e-5), end = v >= 0 ? 2e-5 : -2e-5;
    s_[4] = std::abs(v) > 1e-12 ? end + (z - end) * fade : z;
    swings_.push_back(s_[2]);
  }

  SampleCrane c_;
  std::mt19937 random_;
  std::vector<Tone> tones_;
  std::vector<double> past_volts_, swings_;
  S s_{};
  double volts_ = 0, drive_ = 0, load_ = 0;
};

}  // namespace crane::innovations::test
