/// The fast method: one-step formulas with error control (one_step.hpp). Each step uses the cheaper formula.
///
/// An event is a change of the sign of a watched distance. The solver finds its time by repeating the step
/// with other lengths, and ends the step there.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "one_step.hpp"
#include "solver.hpp"

namespace crane::simulator {
namespace {

/// Error of the time of an event [s].
constexpr double kEventTime_s = 1e-13;
constexpr int kMostEventTrials = 60;

/// @tparam kInner  see OneStep
template <std::size_t kInner>
class FastSolver final : public Solver {
 public:
  FastSolver(const plant::Model& model, const Tolerances& tolerances) : step_(model, tolerances) {}

  Advance advance(Motion& motion, const plant::Actuation& actuation, double span_s, const Watch& watch,
                  double first_step_s) override {
    watch_ = watch.active() ? &watch : nullptr;
    step_.begin_span(motion, actuation);
    double left_s = span_s, h = first_step_s, next_first_s = 0;
    std::optional<Event> event;
    while (left_s > 0 && !event) {
      h = std::min(h, left_s);
      if (h < left_s && left_s < 2 * h) h = left_s / 2;
      h = step_.select_formula(h);
      const Trial trial = step_.step(h);
      const double next_h = h * growth(trial);
      if (!(trial.error <= 1)) {
        h = next_h;
        if (!(h > kShortest_s)) fail();
        continue;
      }
      if (next_first_s == 0) next_first_s = next_h;
      const auto [reached_s, end, found] = first_event(h, trial);
      left_s -= reached_s;
      step_.end_step(end);
      event = found;
      if (left_s > 0 && !event) step_.begin_step_after(trial);
      h = next_h;
    }
    motion = motion_of(step_.y().data(), kInner);
    return {.elapsed_s = event ? span_s - left_s : span_s, .event = event, .next_first_step_s = next_first_s};
  }
  [[nodiscard]] long evaluations() const noexcept override { return step_.evaluations(); }

 private:
  using Step = OneStep<kInner>;
  using Trial = typename Step::Trial;
  using Vector = typename Step::Vector;

  struct Reached {
    double after_s;
    Vector end;
    std::optional<Event> event;
  };

  /// Ratio of the next step's length to the present length.
  [[nodiscard]] static double growth(const Trial& trial) {
    constexpr double kSafety = 0.9, kLeast = 0.2, kMost = 5;
    if (!std::isfinite(trial.error)) return kLeast;
    if (trial.error == 0) return kMost;
    return std::clamp(kSafety * std::pow(trial.error, -1 / trial.order), kLeast, kMost);
  }

  /// End of a step that begins at step_.y(): the end of the step of length h, or the first event in the step.
  [[nodiscard]] Reached first_event(double h, const Trial& trial) {
    Reached first{h, trial.end, std::nullopt};
    if (watch_ == nullptr) return first;
    std::array<double, kDistances> before{}, after{};
    measure_distances(*watch_, step_.y().data(), Step::kHalf, before.data());
    measure_distances(*watch_, trial.end.data(), Step::kHalf, after.data());
    for (std::size_t i = 0; i < kDistances; ++i) {
      if (before[i] * after[i] > 0 || before[i] == 0) continue;
      const auto [after_s, end] = crossing(i, before[i], h, trial.end, after[i]);
      if (first.event && after_s >= first.after_s) continue;
      first = {after_s, end, event_of(i)};
    }
    return first;
  }

  /// Illinois method for the length of the step at whose end the distance is 0 or has just changed its sign.
  std::pair<double, Vector> crossing(std::size_t distance, double low_value, double high, const Vector& end,
                                     double high_value) {
    double low = 0;
    Vector reached = end;
    int side = 0;  // -1: the last trial moved the lower end of the interval; 1: the upper end
    for (int trial = 0; trial < kMostEventTrials && high - low > kEventTime_s && high_value != 0; ++trial) {
      const double at = high - high_value * (high - low) / (high_value - low_value);
      const Vector there = step_.step(at).end;
      std::array<double, kDistances> value{};
      measure_distances(*watch_, there.data(), Step::kHalf, value.data());
      if (value[distance] * low_value > 0) {
        low = at;
        low_value = value[distance];
        if (side < 0) high_value /= 2;
        side = -1;
      } else {
        high = at;
        high_value = value[distance];
        reached = there;
        if (side > 0) low_value /= 2;
        side = 1;
      }
    }
    return {high, reached};
  }

  [[noreturn]] static void fail() {
    throw std::runtime_error(
        "fast integrator: the step size becomes too small (a swing angle at 90 degrees, or cable length 0)");
  }

  Step step_;
  const Watch* watch_ = nullptr;
};

}  // namespace

std::unique_ptr<Solver> make_fast_solver(const plant::Model& model, const Tolerances& tolerances) {
  if (model.inner_coordinates() == 0) return std::make_unique<FastSolver<0>>(model, tolerances);
  return std::make_unique<FastSolver<plant::kMostInner>>(model, tolerances);
}

}  // namespace crane::simulator
