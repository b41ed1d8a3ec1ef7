#include "report/verdict_section.hpp"

#include "report/value_text.hpp"

namespace crane::diagnosis {
namespace {

report::Tone tone_of_verdict(Verdict verdict) {
  if (verdict == Verdict::none) return report::Tone::good;
  return verdict == Verdict::unknown ? report::Tone::bad : report::Tone::neutral;
}

report::Table causes_table(const std::string& title, const std::vector<Cause>& causes) {
  report::Table table{
      .title = title,
      .header = {"cause", "axis", "parameters (± standard deviation)", "p value alone", "resamples"},
      .rows = {}};
  for (const Cause& cause : causes) {
    std::string parameters;
    for (const Estimate& e : cause.parameters)
      parameters += (parameters.empty() ? "" : ", ") + e.name + " " + with_std(e);
    table.rows.push_back({{cause.name},
                          {cause.axis},
                          {parameters},
                          {significant(cause.p_value, 2)},
                          {percent(cause.resampling_frequency)}});
  }
  return table;
}

report::Table calibration_table(const std::vector<Calibrated>& calibrated) {
  report::Table table{
      .title = "Values that the data prefer within the accuracy of the rig file",
      .header = {"term", "axis", "parameter", "value", "as in the rig file", "accuracy +-", "unit"},
      .rows = {}};
  for (const Calibrated& quantity : calibrated)
    for (const auto& p : quantity.parameters)
      table.rows.push_back({{quantity.name},
                            {quantity.axis},
                            {p.name},
                            {significant(p.value, 4)},
                            {significant(p.null, 4)},
                            {significant(p.limit, 2)},
                            {p.unit}});
  return table;
}

/// A gain whose interval contains zero is not proven.
std::string gain_sentence(const HeldOut& held_out) {
  const auto [low, high] = held_out.gain_ci95;
  const std::string interval = " (95 % interval " + percent(low) + " to " + percent(high) + ").";
  const std::string begin = "On data that were not used for the fit, the extended model's error is ";
  if (low > 0) return begin + "smaller by " + percent(held_out.gain) + interval;
  if (high < 0)
    return begin + "larger by " + percent(-held_out.gain) + ": gain " + percent(held_out.gain) + interval;
  return begin + "not significantly smaller: gain " + percent(held_out.gain) + interval;
}

}  // namespace

report::Section verdict_section(const Diagnosis& diagnosis) {
  report::Section section{.title = "Verdict", .blocks = {}};
  section.blocks.emplace_back(
      report::Verdict{.text = diagnosis.sentence, .tone = tone_of_verdict(diagnosis.verdict)});
  if (!diagnosis.extension.empty())
    section.blocks.emplace_back(report::Paragraph{gain_sentence(diagnosis.held_out)});
  if (!diagnosis.causes.empty()) section.blocks.emplace_back(causes_table("Causes", diagnosis.causes));
  if (!diagnosis.within_accuracy.empty())
    section.blocks.emplace_back(
        causes_table("Within the accuracy of the rig file", diagnosis.within_accuracy));
  if (!diagnosis.calibrated.empty()) section.blocks.emplace_back(calibration_table(diagnosis.calibrated));
  if (!diagnosis.attempted.empty())
    section.blocks.emplace_back(causes_table("Best explanation, not proven as a cause", diagnosis.attempted));
  return section;
}

}  // namespace crane::diagnosis
