/// Results of the experiment: estimates of both regressions, rig file, figures.
#include <cmath>
#include <nlohmann/json.hpp>

#include "crane/configuration/extended_file.hpp"
#include "crane/plant/coordinates.hpp"
#include "identification/axis_data.hpp"
#include "identification/friction_experiment.hpp"

namespace crane::identification {
namespace {

namespace id = identification;
using recording::shortest;

nlohmann::ordered_json json_of(const id::Estimate& estimate) {
  return {{"value", estimate.value}, {"standard_error", estimate.standard_error}};
}

nlohmann::ordered_json json_of(const id::FrictionEstimate& estimate) {
  return {{"viscous_positive", json_of(estimate.viscous_positive)},
          {"viscous_negative", json_of(estimate.viscous_negative)},
          {"coulomb_positive_v", json_of(estimate.coulomb_positive)},
          {"coulomb_negative_v", json_of(estimate.coulomb_negative)},
          {"gain", json_of(estimate.gain)},
          {"rows_positive", estimate.rows_positive},
          {"rows_negative", estimate.rows_negative},
          {"residual_rms_v", estimate.residual_rms_v}};
}

nlohmann::ordered_json json_of(const id::Stiction& stiction) {
  return {{"mean_v", stiction.mean_v}, {"spread_v", stiction.spread_v}, {"count", stiction.count}};
}

nlohmann::ordered_json json_of(const id::Deviation& deviation) {
  return {{"rms", deviation.rms}, {"peak", deviation.peak}};
}

}  // namespace

FrictionEstimates estimate_both(const id::AxisRun& run, double zero_band, double cutoff_ratio, double gain) {
  id::FrictionOptions options;
  options.zero_band = zero_band;
  options.cutoff_ratio = cutoff_ratio;
  options.gain = gain;
  FrictionEstimates estimates;
  estimates.midpoint = id::estimate_friction(run, options);
  options.regression = id::Regression::dissertation;
  estimates.dissertation = id::estimate_friction(run, options);
  std::string text;
  for (const auto& problem : id::contradictions(estimates.midpoint))
    text += (text.empty() ? "" : "; ") + problem;
  if (!text.empty()) throw id::IdentificationError(text);
  options.regression = id::Regression::midpoint;
  options.gain.reset();
  try {
    estimates.midpoint_joint = id::estimate_friction(run, options);
  } catch (const id::IdentificationError& refusal) {
    estimates.gain_refusal = refusal.what();
  }
  return estimates;
}

std::string friction_fragment(const std::filesystem::path& rig, std::size_t axis,
                              const id::FrictionEstimate& friction, const id::StictionEstimate& stiction) {
  const std::string per_speed = axis == plant::kTrolley ? "vspm" : "vsprad";
  const auto line = [](const std::string& key, double value, const std::string& comment) {
    const double rounded =
        std::max(0.0, std::round(value * 1e4) / 1e4);  // contradictions() has checked the sign
    return key + " = " + shortest(rounded) + "  # " + comment + "\n";
  };
  const auto estimate = [&line](const std::string& key, const id::Estimate& e) {
    return line(key, e.value, "+- " + shortest(std::round(e.standard_error * 1e5) / 1e5));
  };
  const auto stick = [&line](const std::string& key, const id::Stiction& s) {
    return line(key, s.mean_v,
                "spread " + shortest(std::round(s.spread_v * 1e5) / 1e5) + " of " + std::to_string(s.count));
  };
  return "# Friction of the " + std::string{plant::kCoordinates[axis].name} +
         ", identified values for the compensation. After +-: one standard error.\nextends = " +
         configuration::toml_string(std::filesystem::absolute(rig).string()) + "\n\n[controller.friction." +
         plant::kCoordinates[axis].name + "]\n" +
         estimate("viscous_positive_" + per_speed, friction.viscous_positive) +
         estimate("viscous_negative_" + per_speed, friction.viscous_negative) +
         estimate("coulomb_positive_v", friction.coulomb_positive) +
         estimate("coulomb_negative_v", friction.coulomb_negative) +
         stick("stiction_positive_v", stiction.positive) + stick("stiction_negative_v", stiction.negative) +
         "factor = 1.0\n";
}

nlohmann::ordered_json to_json(const FrictionEstimates& estimates) {
  nlohmann::ordered_json json{{"dissertation", json_of(estimates.dissertation)},
                              {"midpoint", json_of(estimates.midpoint)}};
  if (estimates.midpoint_joint)
    json["midpoint_joint"] = json_of(*estimates.midpoint_joint);
  else
    json["gain_refusal"] = estimates.gain_refusal;
  return json;
}

nlohmann::ordered_json to_json(const FrictionExperimentResult& result) {
  nlohmann::ordered_json json{{"rig", result.rig},
                              {"axis", plant::kCoordinates[result.axis].name},
                              {"unit", plant::kCoordinates[result.axis].unit},
                              {"amplitude_share", result.amplitude_share}};
  json.update(to_json(result.estimates));
  json["stiction"] = {{"positive", json_of(result.stiction.positive)},
                      {"negative", json_of(result.stiction.negative)}};
  json["steps"] = {{"size", result.step},
                   {"compensated", json_of(result.compensated)},
                   {"uncompensated", json_of(result.uncompensated)}};
  json["rig_file"] = result.fragment.string();
  return json;
}

}  // namespace crane::identification
