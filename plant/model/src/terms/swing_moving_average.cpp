#include "crane/plant/term.hpp"
#include "terms/sample_history.hpp"
#include "terms/swing_channels.hpp"

namespace crane::plant {
namespace {

/// Mean of the linearly interpolated signal over the last `ticks` ticks.
double mean_of_polygon(const SampleHistory& past, double ticks) {
  const double whole = std::floor(ticks), share = ticks - whole;
  const auto last = static_cast<std::size_t>(whole);
  double area = 0;
  for (std::size_t i = 0; i < last; ++i) area += 0.5 * (past.before(i) + past.before(i + 1));
  area += share * 0.5 * (past.before(last) + past.before(ticks));
  return area / ticks;
}

class SwingMovingAverage final : public Term {
 public:
  explicit SwingMovingAverage(const TermSetting& s) : axis_(s.axis), window_s_(s.parameters.at("window_s")) {}

  void change_measurement(Measurement& measured, double period_s) noexcept override {
    const double ticks = std::min(window_s_ / period_s, SampleHistory::kMostTicks);
    for_each_swing(axis_, measured, [&](double& angle_rad, std::size_t i) {
      if (!begun_) past_rad_[i].fill(angle_rad);
      past_rad_[i].push(angle_rad);
      if (ticks > 0) angle_rad = mean_of_polygon(past_rad_[i], ticks);
    });
    begun_ = true;
  }

 private:
  SwingAxes axis_;
  double window_s_;
  std::array<SampleHistory, 2> past_rad_;
  bool begun_ = false;
};

}  // namespace

TermKind swing_moving_average() {
  return {
      .name = "swing_moving_average",
      .equation =
          "phi_measured(t) = 1/w integral of phi from t - w to t, phi interpolated linearly between ticks",
      .effect =
          "the swing sensor averages its samples; n samples with equal weights correspond to w = (n - 1) "
          "ticks",
      .acts_on = ActsOn::sensor,
      .axes = {"radial", "tangential", ""},
      .parameters = {{"window_s", "s", 0, 0, 0.5, "w, length of the window"}},
      .example = {"swing_moving_average", "tangential", {{"window_s", 0.05}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<SwingMovingAverage>(s);
      }};
}

}  // namespace crane::plant
