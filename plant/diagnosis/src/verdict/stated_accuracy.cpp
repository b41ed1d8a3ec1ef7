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
/// axis [m2/s4 or rad2/s4]. Rows in which the axis rests are left out: static friction takes any value there.
std::array<double, 2> acceleration_squares(const Runs& runs, const Replays& a, const Replays& b) {
  std::array<double, 2> squares{};
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const Output axis : simulated_outputs(runs[r], Part::drive)) {
      const std::vector<double>& rate = runs[r].motion[axis].rate;
      const std::vector<double>&of_a = a[r].increments_along_measurement(axis).speed_change,
            &of_b = b[r].increments_along_measurement(axis).speed_change;
      for (std::size_t row = 0; row < rate.size(); ++row)
        if (std::abs(rate[row]) >= kStandstillSpeed)
          squares[axis] += std::pow((of_a[row] - of_b[row]) / runs[r].run.period_s, 2);
    }
  return squares;
}

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

std::vector<bool> StatedAccuracy::contains_each(const Study& study, const Fitted& fitted) const {
  const Effects& effects = fitted.effects;
  if (effects.empty()) return {};
  const auto crane_with = [&](const Effects& some) {
    return study.crane(fitted.nuisance.inaccuracies, some);
  };
  const Crane rig_file = crane_with({}), extended = crane_with(effects);
  const std::vector<Crane> inaccurate = inaccurate_cranes(study, rig_file);
  std::vector<Crane> without_each;
  for (std::size_t i = 0; i < effects.size(); ++i) without_each.push_back(crane_with(without(effects, i)));
  Changes largest{};
  std::vector<Changes> by_effect(effects.size(), Changes{});
  for (const Problem* part : {&study.train().drive, &study.train().load, &study.whole_runs()}) {
    if (part->empty()) continue;
    const std::size_t first = part == &study.whole_runs() ? kOutputs : 0;
    const auto changes = [&](const Replays& crane, const Fits& at) {
      Changes squares{};
      const std::vector<double> of_outputs = part->squares_changed(crane, at);
      for (std::size_t i = 0; i < of_outputs.size(); ++i) squares[first + part->outputs()[i]] = of_outputs[i];
      return squares;
    };
    const auto add_accelerations = [&](const Replays& changed, const Replays& unchanged, Changes& squares) {
      if (part != &study.train().drive) return;
      const auto of_axes = acceleration_squares(part->runs(), changed, unchanged);
      std::ranges::copy(of_axes, squares.begin() + 2 * kOutputs);
    };
    const Replays replays_of_rig_file = replays_of(part->runs(), rig_file);
    const Fits of_rig_file = part->fit(replays_of_rig_file);
    for (const Crane& crane : inaccurate) {
      const Replays replays = replays_of(part->runs(), crane);
      Changes by_inaccuracy = changes(replays, of_rig_file);
      add_accelerations(replays, replays_of_rig_file, by_inaccuracy);
      for (std::size_t i = 0; i < largest.size(); ++i) largest[i] = std::max(largest[i], by_inaccuracy[i]);
    }
    const Replays replays_of_extended = replays_of(part->runs(), extended);
    const Fits of_extended = part->fit(replays_of_extended);
    for (std::size_t i = 0; i < effects.size(); ++i) {
      const Replays replays = replays_of(part->runs(), without_each[i]);
      Changes of_part = changes(replays, of_extended);
      add_accelerations(replays, replays_of_extended, of_part);
      for (std::size_t k = 0; k < of_part.size(); ++k) by_effect[i][k] += of_part[k];
    }
  }
  std::vector<bool> contained;
  std::span<const double> std_dev = fitted.interval_std_dev;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    contained.push_back(limits_of(*effects[i].candidate).empty()
                            ? is_error_of_zero(study, effects[i]) ||
                                  std::ranges::equal(by_effect[i], largest, std::less_equal{})
                            : contains_values(effects[i], std_dev, deviations_beyond(study)));
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
