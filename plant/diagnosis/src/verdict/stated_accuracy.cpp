#include "verdict/stated_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "quantile.hpp"
#include "replay/standstill.hpp"
#include "rules.hpp"
#include "search/parts.hpp"
#include "study/inaccuracies.hpp"

namespace crane::diagnosis {
namespace {

/// Whether the inaccuracy of this quantity limits other effects too. An error of the cable length or of a
/// time turns the phase of the swing, which no other effect does: the swing is limited by the error of its
/// scale.
bool is_limit(const Candidate& candidate) {
  return candidate.cause != "cable_length" && candidate.cause != "payload_mass" &&
         candidate.cause != "swing_delay" && candidate.cause != "swing_moving_average";
}

/// Another quantity with the same accuracy has the same effect: of the scale of the swing that of the
/// measured support, of the scale of a position the gain of its drive, and of gain and inertia the scale.
/// Both errors add.
bool is_confounded_with_a_scale(const Candidate& candidate) {
  return candidate.cause == "swing_scale" || candidate.cause == "position_scale" ||
         candidate.cause == "motor_gain" || candidate.cause == "drive_inertia";
}

/// The load hangs anywhere within one resolution of the sensor when the sensor is zeroed.
bool is_error_of_zero(const Study& study, const Effect& effect) {
  if (effect.candidate->cause != "swing_offset") return false;
  const Output output = effect.candidate->axis == axis_of(kRadialSwing) ? kRadialSwing : kTangentialSwing;
  const double half_a_resolution = std::sqrt(3.0) * study.zero_std_dev(output);
  return std::abs(effect.values[0]) <= half_a_resolution;
}

/// Sums of squares of the differences between the accelerations of two cranes along the measured motion, by
/// run and axis [m2/s4 or rad2/s4]. Rows in which the axis rests are left out: static friction takes any
/// value there.
std::vector<double> acceleration_squares(const Runs& runs, const Replays& a, const Replays& b) {
  std::vector<double> squares;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const Output axis : simulated_outputs(runs[r], Part::drive)) {
      const std::vector<double>& rate = runs[r].motion[axis].rate;
      const std::vector<double>&of_a = a[r].increments_along_measurement(axis).speed_change,
            &of_b = b[r].increments_along_measurement(axis).speed_change;
      double sum = 0;
      for (std::size_t row = 0; row < rate.size(); ++row)
        if (std::abs(rate[row]) >= kStandstillSpeed)
          sum += std::pow((of_a[row] - of_b[row]) / runs[r].run.period_s, 2);
      squares.push_back(sum);
    }
  return squares;
}

/// Simulation of a crane to which others are compared.
class Reference {
 public:
  Reference(const Problem& part, Part which, const Crane& crane)
      : part_(part), which_(which), replays_(replays_of(part.runs(), crane)), fits_(part.fit(replays_)) {}

  /// Sums of squares of the differences from another crane: by run and output [m2 or rad2], then of the
  /// accelerations of the drives.
  [[nodiscard]] std::vector<double> squares_to(const Crane& crane) const {
    const Replays changed = replays_of(part_.runs(), crane);
    const std::size_t outputs = part_.outputs().size();
    std::vector<double> squares(part_.runs().size() * outputs, 0.0);
    const auto of_windows = part_.squares_changed(changed, fits_);
    for (std::size_t w = 0; w < of_windows.size(); ++w)
      for (std::size_t i = 0; i < outputs; ++i)
        squares[part_.windows()[w].run * outputs + i] += of_windows[w][i];
    if (which_ == Part::drive) {
      const std::vector<double> of_accelerations = acceleration_squares(part_.runs(), changed, replays_);
      squares.insert(squares.end(), of_accelerations.begin(), of_accelerations.end());
    }
    return squares;
  }

  /// The same for the noise that the resolution of the sensors causes: a smaller difference is not visible. 0
  /// for accelerations.
  [[nodiscard]] std::vector<double> squares_of_noise() const {
    const std::vector<Output>& outputs = part_.outputs();
    const std::size_t differences = part_.runs().size() * outputs.size();
    std::vector<double> squares(which_ == Part::drive ? 2 * differences : differences, 0.0);
    for (const Window& window : part_.windows())
      for (std::size_t i = 0; i < outputs.size(); ++i)
        squares[window.run * outputs.size() + i] +=
            static_cast<double>(window.rows) * std::pow(least_noise_of(part_.runs(), outputs[i]), 2);
    return squares;
  }

 private:
  const Problem& part_;
  Part which_;
  Replays replays_;
  Fits fits_;
};

}  // namespace

StatedAccuracy::StatedAccuracy(const configuration::Rig& rig, const Accuracy& accuracy)
    : rig_(rig),
      accuracy_(accuracy),
      friction_{known_friction(rig, "trolley"), known_friction(rig, "slew")} {}

std::vector<double> StatedAccuracy::limits_of(const Candidate& candidate) const {
  return largest_inaccuracy(candidate.cause, candidate.axis, rig_, accuracy_);
}

double StatedAccuracy::deviations_beyond(const Study& study) const {
  const auto tests = std::ranges::count_if(
      study.candidates(), [this](const Candidate& candidate) { return is_stated(candidate); });
  return upper_quantile(rules::kFamilywiseLevel / (2 * static_cast<double>(tests)));
}

bool StatedAccuracy::contains_values(const Effect& effect, std::span<const double> std_dev,
                                     double deviations) const {
  std::vector<double> limits = limits_of(*effect.candidate);
  if (is_confounded_with_a_scale(*effect.candidate)) limits[0] += accuracy_.values;
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (std::abs(effect.values[i] - effect.candidate->parameters[i].null) >
        limits[i] + deviations * std_dev[i])
      return false;
  return true;
}

std::vector<Crane> StatedAccuracy::inaccurate_cranes(const Study& study, const Crane& crane) const {
  std::vector<Crane> cranes;
  std::map<std::string, std::size_t> of_friction;  // by axis: one crane
  for (const Candidate& candidate : study.candidates()) {
    const std::vector<double> limits = limits_of(candidate);
    if (limits.size() != 1 || limits[0] == 0 || !is_limit(candidate)) continue;
    std::size_t at = cranes.size();
    if (candidate.law == GoesWith::speed) at = of_friction.try_emplace(candidate.axis, at).first->second;
    if (at == cranes.size()) cranes.push_back(crane);
    cranes[at].terms.push_back(candidate.setting({candidate.parameters[0].null + limits[0]}));
  }
  return cranes;
}

std::vector<bool> StatedAccuracy::changes_little(const Study& study, const Fitted& fitted) const {
  const Effects& effects = fitted.effects;
  const auto crane_with = [&](const Effects& some) {
    return study.crane(fitted.nuisance.inaccuracies, some);
  };
  const Crane rig_file = crane_with({}), extended = crane_with(effects);
  const std::vector<Crane> inaccurate = inaccurate_cranes(study, rig_file);
  std::vector<bool> little(effects.size(), true);
  for (const auto& [part, which] : {std::pair{&study.train().drive, Part::drive},
                                    {&study.train().load, Part::load},
                                    {&study.test().drive, Part::drive},
                                    {&study.test().load, Part::load},
                                    {&study.whole_runs(), Part::load}}) {
    if (part->empty()) continue;
    const Reference of_rig_file(*part, which, rig_file), of_extended(*part, which, extended);
    std::vector<double> largest = of_rig_file.squares_of_noise();
    for (const Crane& crane : inaccurate)
      std::ranges::transform(largest, of_rig_file.squares_to(crane), largest.begin(),
                             [](double a, double b) { return std::max(a, b); });
    for (std::size_t i = 0; i < effects.size(); ++i)
      little[i] = little[i] && std::ranges::equal(of_extended.squares_to(crane_with(without(effects, i))),
                                                  largest, std::less_equal{});
  }
  return little;
}

std::vector<bool> StatedAccuracy::contains_each(const Study& study, const Fitted& fitted) const {
  const Effects& effects = fitted.effects;
  if (effects.empty()) return {};
  std::vector<bool> contained = changes_little(study, fitted);
  std::span<const double> std_dev = fitted.interval_std_dev;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    contained[i] = is_stated(*effects[i].candidate)
                       ? contains_values(effects[i], std_dev, deviations_beyond(study))
                       : contained[i] || is_error_of_zero(study, effects[i]);
    std_dev = std_dev.subspan(effects[i].values.size());
  }
  return contained;
}

bool StatedAccuracy::contains(const Unexplained& pattern) const {
  if (pattern.output > kSlewAngle) return false;
  const bool slews = pattern.output == kSlewAngle;
  const double gain = slews ? rig_.plant.slew_gain_radps2pv : rig_.plant.trolley_gain_mps2pv;
  return pattern.acceleration <= accuracy_.friction * gain * friction_[pattern.output].least_coulomb_v;
}

std::optional<SignificantDriveError> StatedAccuracy::drive_error_beyond(const WhitenedData& data,
                                                                        const Crane& crane) const {
  return significant_drive_error(data, crane, rig_, accuracy_);
}

}  // namespace crane::diagnosis
