#include "noise/learning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "noise/likelihood.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::VectorXd;

constexpr int kSweeps = 8;
/// Grid of c of a drive.
constexpr std::array kDampings_ps{0.0, 1.0, 4.0, 12.0};
/// Grid of the correlation time of a; 0: white.
constexpr std::array kCorrelations_s{0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0};
/// A sweep that decreases minus twice the log likelihood by less is the last one.
constexpr double kWorthASweep = 1;
/// Largest number of searches with inaccurate times; they end when the noise changes by less than this share.
constexpr int kScaleRounds = 4;
constexpr double kSameScale = 0.03;
/// A search from scratch uses about this number of windows, evenly distributed; a search near its result uses
/// all.
constexpr std::size_t kFewWindows = 12;

/// Coordinate search on grids. Accelerations are in multiples of the noise.
class Learning {
 public:
  Learning(const std::vector<VectorXd>& residuals, const std::vector<WindowMotion>& motions,
           double least_noise)
      : residuals_(residuals), motions_(motions), least_noise_(least_noise) {}

  Disturbance run(const Disturbance& near) {
    if (near.noise > 0) return likeliest_near(near);
    Disturbance start;
    start.noise = 1;
    start.correlation_s = 0.2;
    start.unit = std::numeric_limits<double>::infinity();
    const Disturbance best = search(start);
    if (pendulum()) return best;
    start.sticks = true;
    start.friction = 1;
    const Disturbance sticking = search(start);
    const Disturbance& likelier = sticking.misfit < best.misfit ? sticking : best;
    return inaccurate_times() ? likeliest_near(likelier) : likelier;
  }

 private:
  static Disturbance in_noises(Disturbance d) {
    d.acceleration /= d.noise;
    d.friction /= d.noise;
    d.unit = d.noise;
    d.noise = 1;
    return d;
  }

  /// The likeliest of `near` and the results of searches from it. The inaccuracy of the speed has a known
  /// size, so that its ratio to the noise follows from the noise of the search before. The search is repeated
  /// only with inaccurate times. The result can be less likely than `near` with inaccurate times, or if the
  /// noise is at its lower bound.
  Disturbance likeliest_near(const Disturbance& near) {
    Disturbance best = near, last = near;
    best.misfit = misfit_of(near);
    for (int round = 0; round < kScaleRounds; ++round) {
      Disturbance found = search(in_noises(last));
      if (inaccurate_times()) found.misfit = misfit_of(found);
      if (found.misfit < best.misfit) best = found;
      if (!inaccurate_times() || std::abs(found.noise - last.noise) < kSameScale * last.noise) break;
      last = found;
    }
    return best;
  }

  [[nodiscard]] double misfit_of(const Disturbance& d) const {
    return value_at(d.noise * d.noise, residuals_, motions_, in_noises(d));
  }

  [[nodiscard]] bool inaccurate_times() const {
    return std::ranges::any_of(motions_, [](const WindowMotion& motion) {
      return std::ranges::any_of(motion.profile,
                                 [](const RowMotion& row) { return row.speed_inaccuracy > 0; });
    });
  }

  Disturbance search(const Disturbance& start) {
    best_ = start;
    rejected_.clear();
    found_ = likelihood(residuals_, motions_, best_, {});
    if (best_.acceleration == 0) begin();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const double before = found_.value;
      for (const double factor : {0.3, 0.7, 1.4, 3.0})
        try_with(best_.acceleration, factor * best_.acceleration);
      for (const double correlation_s : colours_near(start, sweep)) try_colour(correlation_s);
      if (!pendulum()) try_drive();
      if (before - found_.value < kWorthASweep) break;
    }
    Disturbance found = best_;
    const double noise = std::sqrt(found_.variance);
    found.acceleration *= noise;
    found.friction *= noise;
    found.noise = std::max(noise, least_noise_);
    found.unit = 1;
    found.misfit = found_.value;
    if (!std::isfinite(found_.value)) found.misfit = 0;  // all residuals are zero
    if (noise > 0 && noise < least_noise_) found.misfit = misfit_of(found);
    return found;
  }

  /// True if a disturbance is likelier than all before; sets found_ to its likelihood. A rejected disturbance
  /// is not evaluated again, because the likelihood of found_ only increases.
  bool is_likelier(const Disturbance& d) {
    const std::array<double, 5> place{d.acceleration, d.correlation_s, d.damping_ps, d.friction,
                                      d.sticks ? 1.0 : 0.0};
    if (std::ranges::find(rejected_, place) != rejected_.end()) return false;
    const Likelihood tried = likelihood(residuals_, motions_, d, found_);
    const bool likelier = tried.value < found_.value;
    if (likelier)
      found_ = tried;
    else
      rejected_.push_back(place);
    return likelier;
  }

  /// Grid of strength and colour: the likelihood has several maxima, for example a weak slow force with a
  /// coarse sensor and a strong fast one with a fine sensor. u is proportional to a.
  void begin() {
    const Disturbance start = best_;
    const double share = start.friction;
    Disturbance likeliest = start;
    for (const double correlation_s : kCorrelations_s)
      for (int decade = -1; decade < 8; ++decade) {
        best_ = start;
        best_.correlation_s = correlation_s;
        best_.acceleration = std::pow(10, decade);
        best_.friction = share * best_.acceleration;
        if (is_likelier(best_)) likeliest = best_;
      }
    best_ = likeliest;
  }

  /// Correlation times of a sweep: all in the first sweep from scratch, later the present one and its
  /// neighbours.
  [[nodiscard]] std::vector<double> colours_near(const Disturbance& start, int sweep) const {
    if (sweep == 0 && start.acceleration == 0) return {kCorrelations_s.begin(), kCorrelations_s.end()};
    std::vector<double> near;
    for (std::size_t i = 0; i < kCorrelations_s.size(); ++i) {
      const std::size_t before = i - std::min<std::size_t>(i, 1),
                        after = std::min(i + 1, kCorrelations_s.size() - 1);
      if (kCorrelations_s[before] <= best_.correlation_s && best_.correlation_s <= kCorrelations_s[after])
        near.push_back(kCorrelations_s[i]);
    }
    return near;
  }

  /// Another correlation time, at the same strength or the same power at low frequencies, with every damping.
  void try_colour(double correlation_s) {
    const Disturbance before = best_;
    const auto lasts = [](double s) { return std::max(s, kCorrelations_s[1] / 2); };
    const double weaker = std::sqrt(lasts(before.correlation_s) / lasts(correlation_s));
    for (const double share : {1.0, weaker})
      for (const double damping_ps : kDampings_ps) {
        if (pendulum() && damping_ps > 0) continue;
        Disturbance tried = before;
        tried.correlation_s = correlation_s;
        tried.acceleration *= share;
        tried.friction *= share;
        tried.damping_ps = damping_ps;
        if (is_likelier(tried)) best_ = tried;
      }
  }

  [[nodiscard]] bool pendulum() const { return motions_.at(0).natural_radps > 0; }

  void try_drive() {
    for (const double damping_ps : kDampings_ps) try_with(best_.damping_ps, damping_ps);
    for (const double share : {0.0, 0.3, 1.0, 3.0, 10.0, 30.0})
      try_with(best_.friction, share * best_.acceleration);
  }

  /// Sets `number`, a member of best_, to `value` if that is likelier.
  template <class Number>
  void try_with(Number& number, Number value) {
    const Number before = number;
    if (value == before) return;
    number = value;
    if (!is_likelier(best_)) number = before;
  }

  const std::vector<VectorXd>& residuals_;
  const std::vector<WindowMotion>& motions_;
  double least_noise_;
  Disturbance best_;
  Likelihood found_;
  /// Acceleration, correlation time, damping, friction and sticking of the disturbances that this search has
  /// rejected.
  std::vector<std::array<double, 5>> rejected_;
};

}  // namespace

Disturbance learn(const std::vector<VectorXd>& residuals, const std::vector<WindowMotion>& motions,
                  double least_noise, const Disturbance& near) {
  const std::size_t stride = residuals.size() / kFewWindows;
  if (near.noise > 0 || stride < 2) return Learning(residuals, motions, least_noise).run(near);
  std::vector<VectorXd> few;
  std::vector<WindowMotion> their_motions;
  for (std::size_t w = stride / 2; w < residuals.size(); w += stride) {
    few.push_back(residuals[w]);
    their_motions.push_back(motions[w]);
  }
  const Disturbance begin = Learning(few, their_motions, least_noise).run({});
  return Learning(residuals, motions, least_noise).run(begin);
}

}  // namespace crane::diagnosis
