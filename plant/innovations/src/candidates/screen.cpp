#include "candidates/screen.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace crane::innovations {
namespace {

/// What the starts of a quiet candidate assume of the unknown force: a quarter of the learnt one.
constexpr double kQuieter = 1.4;

bool is_wave(const Candidate& c) {
  return c.name == "torque_ripple" || c.name == "position_dependent_friction";
}

class Screening {
 public:
  Screening(const Problem& problem, const Fit& base)
      : problem_(problem), base_(base), noise_(problem.noise()) {
    value_ = sum(base.by_value);
    noise_scores_ = scores(problem, base.at, noise_, base.by_value);
  }

  Screened screened(const Candidate& c) const {
    Screened s{&c, 0, 0, base_.at};
    if (is_wave(c)) {
      try_waves(c, s);
      return s;
    }
    if (c.name != "double_pendulum") try_score(c, s);
    for (const auto& values : c.starts) try_values(c, values, false, s);
    if (c.quiet_starts)
      for (const auto& values : quiet_values(c)) try_values(c, values, true, s);
    return s;
  }

 private:
  void attempt(const Hypothesis& h, Screened& s) const {
    const auto l = log_likelihoods(problem_, h);
    if (l.empty()) return;
    if (const double gain = sum(l) - value_; gain > s.gained) s.gained = gain, s.start = h;
  }

  void try_values(const Candidate& c, const std::vector<double>& values, bool quiet, Screened& s) const {
    Hypothesis h = base_.at;
    for (std::size_t i = 0; i < c.theta.size(); ++i) {
      const ParameterInfo& info = problem_.table[c.theta[i]];
      h.values[c.theta[i]] = std::clamp(values[i], info.low, info.high);
    }
    if (quiet) quieten(c, h.values);
    attempt(h, s);
  }

  void quieten(const Candidate& c, Values& v) const {
    for (const std::size_t channel : c.channels) {
      v[of_noise(channel, kLogForce)] -= kQuieter;
      if (channel < 2) v[standstill_of(channel)] -= 0.5 * kQuieter;
    }
  }

  /// Multiples of the learnt unknown force for the first parameter; the starts themselves for structures.
  std::vector<std::vector<double>> quiet_values(const Candidate& c) const {
    if (!c.starts.empty() && c.channels.front() >= 2) return c.starts;
    const double force = std::exp(base_.at.values[of_noise(c.channels.front(), kLogForce)]);
    std::vector<std::vector<double>> all;
    const std::vector<double> like =
        c.starts.empty() ? std::vector<double>(c.theta.size(), 0.0) : c.starts.front();
    for (const double k : {-2.0, -1.0, 1.0, 2.0}) {
      std::vector<double> values = like;
      values[0] = base_.at.values[c.theta[0]] + k * force;
      all.push_back(values);
    }
    return all;
  }

  /// Newton step of theta and noise together; its gain less that of the noise alone.
  void try_score(const Candidate& c, Screened& s) const {
    std::vector<Index> theta = c.theta;
    if (c.name == "stribeck_friction") theta.resize(1);
    const Eigen::MatrixXd own = scores(problem_, base_.at, theta, base_.by_value);
    Eigen::MatrixXd both(own.rows(), own.cols() + noise_scores_.cols());
    both << own, noise_scores_;
    Eigen::MatrixXd h = both.transpose() * both;
    for (Eigen::Index i = 0; i < h.rows(); ++i)
      h(i, i) += i < own.cols() ? 1e-6 / std::pow(problem_.table[theta[static_cast<std::size_t>(i)]].scale, 2)
                                : 0.03;
    const Eigen::VectorXd g = both.colwise().sum().transpose(), step = h.ldlt().solve(g);
    const Eigen::Index n = noise_scores_.cols();
    s.promised = 0.5 * g.dot(step) - 0.5 * g.tail(n).dot(h.bottomRightCorner(n, n).ldlt().solve(g.tail(n)));
    for (const double share : {1.0, 0.4, 2.5}) {
      Hypothesis moved = base_.at;
      bool moves = false;
      for (std::size_t i = 0; i < theta.size(); ++i) {
        const ParameterInfo& info = problem_.table[theta[i]];
        double& v = moved.values[theta[i]];
        const double before = v;
        v = std::clamp(v + share * step[static_cast<Eigen::Index>(i)], info.low, info.high);
        moves = moves || v != before;
      }
      if (!moves)
        s.promised = 0;
      else
        attempt(moved, s);
    }
  }

  void try_waves(const Candidate& c, Screened& s) const {
    const std::size_t drive = c.channels.front();
    const bool friction = c.name != "torque_ripple";
    const Wave wave = strongest_wave(problem_, base_.at, drive, friction);
    s.promised = wave.gain;
    if (wave.length <= 0) return;
    const double size = std::hypot(wave.cosine, wave.sine);
    for (const double sign : {1.0, -1.0})
      for (const double share : {1.0, 0.5}) {
        const double phase = std::atan2(sign * wave.sine, sign * wave.cosine);
        if (friction) {  // a (1 + cos(2 pi (p - p0) / w)) / 2: the mean is part of it
          try_values(c, {2 * share * size, phase / 6.283185307 * wave.length, wave.length}, false, s);
        } else {
          try_values(c, {share * sign * wave.sine, share * sign * wave.cosine, wave.length}, false, s);
        }
      }
  }

  const Problem& problem_;
  const Fit& base_;
  std::vector<Index> noise_;
  Eigen::MatrixXd noise_scores_;
  double value_ = 0;
};

}  // namespace

double Screened::rank() const { return std::max(gained, 0.6 * promised); }

std::vector<Screened> screen(const Problem& problem, const Fit& base, const std::vector<Candidate>& library) {
  const Screening screening{problem, base};
  std::vector<Screened> all(library.size());
  tbb::parallel_for(std::size_t{0}, library.size(),
                    [&](std::size_t i) { all[i] = screening.screened(library[i]); });
  std::stable_sort(all.begin(), all.end(),
                   [](const Screened& a, const Screened& b) { return a.rank() > b.rank(); });
  return all;
}

}  // namespace crane::innovations
