#include "crane/diagnosis/report.hpp"

#include "rules.hpp"

namespace crane::diagnosis {
namespace {

using nlohmann::ordered_json;

ordered_json parameters_json(const std::vector<Estimate>& estimates) {
  ordered_json json = ordered_json::object();
  for (const Estimate& e : estimates)
    json[e.name] = {{"value", e.value}, {"std", e.std_dev}, {"unit", e.unit}};
  return json;
}

ordered_json causes_json(const std::vector<Cause>& causes) {
  ordered_json json = ordered_json::array();
  for (const Cause& cause : causes)
    json.push_back({{"name", cause.name},
                    {"axis", cause.axis},
                    {"parameters", parameters_json(cause.parameters)},
                    {"p_value", cause.p_value},
                    {"resampling_frequency", cause.resampling_frequency}});
  return json;
}

ordered_json calibrated_json(const std::vector<Calibrated>& calibrated) {
  ordered_json json = ordered_json::array();
  for (const Calibrated& quantity : calibrated) {
    ordered_json parameters = ordered_json::object();
    for (const auto& p : quantity.parameters)
      parameters[p.name] = {{"value", p.value}, {"rig_file", p.null}, {"limit", p.limit}, {"unit", p.unit}};
    json.push_back({{"name", quantity.name}, {"axis", quantity.axis}, {"parameters", parameters}});
  }
  return json;
}

ordered_json candidates_json(const std::vector<Ranked>& ranking) {
  ordered_json json = ordered_json::array();
  for (const Ranked& ranked : ranking) {
    // A list: two effects may have a parameter of the same name.
    ordered_json parameters = ordered_json::array();
    for (const Estimate& e : ranked.parameters)
      parameters.push_back({{"name", e.name}, {"value", e.value}, {"std", e.std_dev}, {"unit", e.unit}});
    json.push_back({{"label", ranked.label},
                    {"parameters", parameters},
                    {"train_gain", ranked.train_gain},
                    {"p_value", ranked.p_value},
                    {"resampling_frequency", ranked.resampling_frequency}});
  }
  return json;
}

ordered_json held_out_json(const HeldOut& held_out) {
  return {{"baseline_rms", held_out.baseline_rms},
          {"extended_rms", held_out.extended_rms},
          {"noise", held_out.noise},
          {"whole_baseline_rms", held_out.whole_baseline_rms},
          {"whole_extended_rms", held_out.whole_extended_rms},
          {"held_value_rms", held_out.held_value_rms},
          {"whole_held_value_rms", held_out.whole_held_value_rms},
          {"whole_extended_motion", held_out.whole_extended_motion},
          {"gain", held_out.gain},
          {"gain_ci95", held_out.gain_ci95},
          {"nats", held_out.nats},
          {"likelier", held_out.likelier}};
}

ordered_json excitation_json(const std::vector<Visibility>& excitation) {
  ordered_json json = ordered_json::array();
  for (const Visibility& visibility : excitation) {
    ordered_json least = ordered_json::object(), alike = ordered_json::array();
    for (const Estimate& e : visibility.least) least[e.name] = {{"value", e.value}, {"unit", e.unit}};
    for (const auto& other : visibility.alike)
      alike.push_back({{"label", other.label}, {"cosine", other.cosine}});
    json.push_back(
        {{"label", visibility.label}, {"visible", visibility.visible}, {"least", least}, {"alike", alike}});
  }
  return json;
}

ordered_json rules_json() {
  ordered_json json = ordered_json::array();
  for (const Rule& rule : rules::kAll)
    json.push_back({{"name", rule.name},
                    {"value", rule.value},
                    {"unit", rule.unit},
                    {"meaning", rule.meaning},
                    {"source", rule.source}});
  return json;
}

ordered_json motion_json(const NextExperiment& next) {
  return {{"name", next.name}, {"description", next.description}, {"separation", next.separation}};
}

}  // namespace

ordered_json to_json(const Check& check) {
  ordered_json next = ordered_json::array();
  for (const Check::Proposal& proposal : check.next)
    next.push_back({{"of", proposal.of}, {"from", proposal.from}, {"motion", motion_json(proposal.motion)}});
  return {{"excitation", excitation_json(check.excitation)}, {"next", next}};
}

ordered_json to_json(const Diagnosis& diagnosis) {
  ordered_json next;  // null without a proposal
  if (diagnosis.next_experiment) next = motion_json(*diagnosis.next_experiment);
  return {{"verdict", name_of(diagnosis.verdict)},
          {"sentence", diagnosis.sentence},
          {"causes", causes_json(diagnosis.causes)},
          {"within_accuracy", causes_json(diagnosis.within_accuracy)},
          {"calibrated", calibrated_json(diagnosis.calibrated)},
          {"attempted", causes_json(diagnosis.attempted)},
          {"ambiguous_with", diagnosis.ambiguous_with},
          {"next_experiment", next},
          {"held_out", held_out_json(diagnosis.held_out)},
          {"residual",
           {{"predictable_fraction", diagnosis.remainder.predictable_fraction},
            {"from", diagnosis.remainder.from}}},
          {"candidates", candidates_json(diagnosis.ranking)},
          {"excitation", excitation_json(diagnosis.excitation)},
          {"detection_p_value", diagnosis.detection_p_value},
          {"accuracy",
           {{"values", diagnosis.accuracy.values},
            {"friction", diagnosis.accuracy.friction},
            {"times_periods", diagnosis.accuracy.times_periods}}},
          {"rules", rules_json()},
          {"notes", diagnosis.notes},
          {"runtime_s", diagnosis.runtime_s}};
}

}  // namespace crane::diagnosis
