#include "sanity/open_loop.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

using Vector = Eigen::VectorXd;

class Shooting {
 public:
  Shooting(const Problem& problem, const Hypothesis& h, const Run& window)
      : problem_(problem),
        h_(h),
        window_(window),
        model_{problem.nominal, problem.layout(h.values), h.values, problem.scales} {
    const Layout& layout = model_.layout;
    for (std::size_t c = 0; c < 4; ++c)
      if (const std::size_t b = layout.begin[c]; b != kNone) {
        const bool drive = c == kX || c == kGamma;
        const std::size_t i = c == kX ? 0 : 1;
        const double q = drive ? problem.scales.travel[i] : problem.scales.swing_rad;
        const double v =
            drive ? problem.scales.speed[i] : problem.scales.swing_rad * problem.scales.omega_radps;
        if (!drive || layout.volts[i]) add(b, q), add(b + 1, v);
      }
    for (const std::size_t b : layout.lower)
      if (b != kNone)
        add(b, problem.scales.swing_rad), add(b + 1, problem.scales.swing_rad * problem.scales.omega_radps);
  }

  [[nodiscard]] Simulated best(const Vector& guess) const {
    Simulated best = from(guess);
    for (const double slope : {1.0, 0.0}) {
      Simulated other = from(measured_start(guess, slope));
      if (cost(other) < cost(best)) best = std::move(other);
    }
    double damping = 1e-3;
    for (int round = 0; round < 10; ++round) {
      const double before = cost(best);
      if (!improve(best, damping) || before - cost(best) < 1e-4 * before) break;
    }
    return best;
  }

 private:
  void add(std::size_t index, double scale) {
    free_.push_back(static_cast<Eigen::Index>(index));
    scale_.push_back(std::max(scale, 1e-6));
  }

  [[nodiscard]] Simulated from(const Vector& start) const {
    FilterRequest request{problem_.between, false, nullptr, {}, &start};
    return {filter(model_, problem_.nominal, problem_.scales, window_, h_.values, request), start};
  }

  [[nodiscard]] Vector measured_start(const Vector& guess, double slope) const {
    Vector s = guess;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const std::size_t b = model_.layout.begin[kCoordinateOf[c]];
      if (b == kNone || window_.measured[c].empty()) continue;
      const Series& y = window_.measured[c];
      const std::size_t k = std::min<std::size_t>(y.size() - 1, 5);
      s[static_cast<Eigen::Index>(b)] = y.value[0];
      if (k > 0)
        s[static_cast<Eigen::Index>(b) + 1] = slope * (y.value[k] - y.value[0]) / (y.time_s[k] - y.time_s[0]);
    }
    for (std::size_t k = 0; k < 2; ++k)
      if (const std::size_t b = model_.layout.lower[k]; b != kNone) {
        const auto upper = static_cast<Eigen::Index>(model_.layout.begin[k == 0 ? kPhi : kTheta]);
        s[static_cast<Eigen::Index>(b)] = s[upper], s[static_cast<Eigen::Index>(b) + 1] = s[upper + 1];
      }
    return s;
  }

  /// Sensors weigh by their noise, at least a thousandth of their range.
  [[nodiscard]] Vector weighted(const Simulated& s) const {
    Vector r(static_cast<Eigen::Index>(s.out.e.size()));
    for (std::size_t k = 0; k < s.out.e.size(); ++k) {
      const std::size_t c = s.out.channel[k];
      const double range = c < 2 ? problem_.scales.travel[c] : problem_.scales.swing_rad;
      r[static_cast<Eigen::Index>(k)] = s.out.e[k] / std::hypot(std::sqrt(s.out.variance[k]), 1e-3 * range);
    }
    return r;
  }
  [[nodiscard]] double cost(const Simulated& s) const {
    return s.out.finite ? weighted(s).squaredNorm() : 1e300;
  }

  bool improve(Simulated& best, double& damping) const {
    const Vector r = weighted(best);
    Eigen::MatrixXd j(r.size(), static_cast<Eigen::Index>(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i) {
      Vector moved = best.start;
      moved[free_[i]] += 1e-4 * scale_[i];
      const Simulated there = from(moved);
      if (!there.out.finite) return false;
      j.col(static_cast<Eigen::Index>(i)) = (weighted(there) - r) / 1e-4;
    }
    const Eigen::MatrixXd h = j.transpose() * j;
    const Vector g = j.transpose() * r;
    for (int attempt = 0; attempt < 5; ++attempt) {
      Eigen::MatrixXd damped = h;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-12;
      const Vector step = damped.ldlt().solve(g);
      Vector moved = best.start;
      for (std::size_t i = 0; i < free_.size(); ++i)
        moved[free_[i]] -= step[static_cast<Eigen::Index>(i)] * scale_[i];
      Simulated there = from(moved);
      if (cost(there) < cost(best)) {
        best = std::move(there);
        damping = std::max(1e-6, damping / 10);
        return true;
      }
      damping *= 8;
    }
    return false;
  }

  const Problem& problem_;
  const Hypothesis& h_;
  const Run& window_;
  CraneModel model_;
  std::vector<Eigen::Index> free_;
  std::vector<double> scale_;
};

WindowError error_of(const Run& window, const Simulated& s, std::size_t run) {
  WindowError error;
  error.run = run;
  std::size_t slot = 0;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const Series& y = window.measured[c];
    double mean = 0, simulated_mean = 0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      mean += y.value[k] / static_cast<double>(y.size());
      simulated_mean += (y.value[k] - s.out.e[slot + k]) / static_cast<double>(y.size());
    }
    for (std::size_t k = 0; k < y.size(); ++k) {
      error.squares[c] += std::pow(s.out.e[slot + k], 2);
      error.held_squares[c] += std::pow(y.value[k] - y.value[0], 2);
      error.motion[c] += std::pow(y.value[k] - mean, 2);
      error.simulated_motion[c] += std::pow(y.value[k] - s.out.e[slot + k] - simulated_mean, 2);
    }
    error.values[c] = y.size();
    slot += y.size();
  }
  return error;
}

/// The filter's state at the first value of any channel from `at_s` on.
Vector filtered_at(const Innovations& whole, double at_s) {
  std::size_t best = 0;
  double time_s = 1e300;
  for (std::size_t k = 0; k < whole.time_s.size(); ++k)
    if (whole.time_s[k] >= at_s && whole.time_s[k] < time_s &&
        !whole.states.col(static_cast<Eigen::Index>(k)).isZero())
      best = k, time_s = whole.time_s[k];
  return whole.states.col(static_cast<Eigen::Index>(best));
}

template <class Part, class Whole>
std::array<double, kChannels> ratio(const std::vector<WindowError>& windows, Part part, Whole whole) {
  std::array<double, kChannels> result{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    double above = 0, below = 0;
    for (const WindowError& w : windows) above += part(w, c), below += whole(w, c);
    result[c] = below > 0 ? std::sqrt(above / below) : 0;
  }
  return result;
}

}  // namespace

std::array<double, kChannels> OpenLoop::rms() const {
  return ratio(
      windows, [](const auto& w, std::size_t c) { return w.squares[c]; },
      [](const auto& w, std::size_t c) { return static_cast<double>(w.values[c]); });
}
std::array<double, kChannels> OpenLoop::held_rms() const {
  return ratio(
      windows, [](const auto& w, std::size_t c) { return w.held_squares[c]; },
      [](const auto& w, std::size_t c) { return static_cast<double>(w.values[c]); });
}
std::array<double, kChannels> OpenLoop::motion_share() const {
  auto share = ratio(
      windows, [](const auto& w, std::size_t c) { return w.simulated_motion[c]; },
      [](const auto& w, std::size_t c) { return w.motion[c]; });
  for (std::size_t c = 0; c < kChannels; ++c)
    if (share[c] == 0 &&
        std::all_of(windows.begin(), windows.end(), [&](const auto& w) { return w.motion[c] == 0; }))
      share[c] = 1;
  return share;
}

Simulated simulate_best(const Problem& problem, const Hypothesis& h, const Run& window, const Vector& guess) {
  return Shooting{problem, h, window}.best(guess);
}

OpenLoop open_loop(const Problem& problem, const Hypothesis& h, double window_s) {
  struct Job {
    std::size_t run;
    Run window;
    Vector guess;
  };
  std::vector<Job> jobs;
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const Run& run = problem.runs[r];
    const Innovations whole = innovations(problem, h, r, nullptr, true);
    const double begin = run.begin_s(), seconds = run.end_s() - begin;
    const auto count =
        window_s > 0 ? std::max<std::size_t>(1, static_cast<std::size_t>(seconds / window_s)) : 1;
    for (std::size_t k = 0; k < count; ++k) {
      const double from = begin + seconds * static_cast<double>(k) / static_cast<double>(count);
      const double to = begin + seconds * static_cast<double>(k + 1) / static_cast<double>(count);
      Run window = cut(run, from, k + 1 == count ? to : to - 1e-9);
      if (window.values() < 8) continue;
      Vector guess = filtered_at(whole, from);
      const Layout layout = problem.layout(h.values);
      for (std::size_t c = 0; c < 4; ++c) {
        const bool followed = kChannelOf[c] < 2 && !layout.volts[kChannelOf[c]];
        if (const std::size_t b = layout.begin[c]; b != kNone && !followed)
          guess[static_cast<Eigen::Index>(b) + 2] = 0;
      }
      jobs.push_back({r, std::move(window), std::move(guess)});
    }
  }
  OpenLoop result;
  result.windows.resize(jobs.size());
  tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
    result.windows[i] =
        error_of(jobs[i].window, simulate_best(problem, h, jobs[i].window, jobs[i].guess), jobs[i].run);
  });
  return result;
}

}  // namespace crane::innovations
