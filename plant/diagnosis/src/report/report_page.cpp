#include "crane/diagnosis/report.hpp"
#include "crane/recording/csv.hpp"
#include "report/residual_view.hpp"
#include "report/value_text.hpp"
#include "report/verdict_section.hpp"

namespace crane::diagnosis {
namespace {

using report::Cell;
using report::Tone;

constexpr std::size_t kMostPoints = 1500;  // of a curve or cloud: the resolution of a screen
constexpr std::size_t kMostCandidates = 20;
constexpr int kMeasuredColor = 8;  // grey

std::vector<double> thinned(const std::vector<double>& values) {
  const std::size_t every = (values.size() + kMostPoints - 1) / kMostPoints;
  if (every <= 1) return values;
  std::vector<double> result;
  for (std::size_t i = 0; i < values.size(); i += every) result.push_back(values[i]);
  return result;
}

/// In mm or mrad; "-" without a value.
Cell in_milli(const std::map<std::string, double>& values, const std::string& column) {
  const auto found = values.find(column);
  return {found == values.end() ? "-" : significant(1000 * found->second, 3)};
}

report::Table gain_table(const HeldOut& held_out) {
  report::Table table{.title = "Held-out error (rms)",
                      .header = {"column", "unit", "simulation", "extended", "gain [95 % interval]",
                                 "sensor and disturbance", "first value held", "simulation, whole run",
                                 "extended, whole run", "first value held, whole run"},
                      .rows = {}};
  for (const char* column : kOutputNames) {
    const auto before = held_out.baseline_rms.find(column), after = held_out.extended_rms.find(column);
    if (before == held_out.baseline_rms.end() || after == held_out.extended_rms.end()) continue;
    table.rows.push_back({{column},
                          {residual_unit(column)},
                          in_milli(held_out.baseline_rms, column),
                          in_milli(held_out.extended_rms, column),
                          report::number(1 - after->second / before->second, 3),
                          in_milli(held_out.noise, column),
                          in_milli(held_out.held_value_rms, column),
                          in_milli(held_out.whole_baseline_rms, column),
                          in_milli(held_out.whole_extended_rms, column),
                          in_milli(held_out.whole_held_value_rms, column)});
  }
  table.rows.push_back(
      {{"all, weighted by noise"},
       {""},
       {""},
       {""},
       report::with_interval(held_out.gain, held_out.gain_ci95[0], held_out.gain_ci95[1], 3)});
  return table;
}

report::LinePlot overlay(const Trace& trace, bool extended) {
  report::LinePlot plot{.title = trace.column + ", " + short_name(trace.run),
                        .x_label = "time [s]",
                        .y_label = trace.column.ends_with("_m") ? "m" : "rad",
                        .x = thinned(trace.time_s),
                        .series = {},
                        .group = trace.run};
  plot.series.push_back(
      {.name = "measured", .x = {}, .y = thinned(trace.measured), .upper = {}, .color = kMeasuredColor});
  plot.series.push_back(
      {.name = "simulation", .x = {}, .y = thinned(trace.baseline), .upper = {}, .color = 1, .dashed = true});
  if (extended)
    plot.series.push_back(
        {.name = "extended", .x = {}, .y = thinned(trace.extended), .upper = {}, .color = 0});
  return plot;
}

report::Section held_out_section(const Diagnosis& diagnosis) {
  report::Section section{.title = "Held-out data", .blocks = {}};
  section.blocks.emplace_back(gain_table(diagnosis.held_out));
  section.blocks.emplace_back(report::Paragraph{
      "The curves are simulations of whole runs in open loop from one initial state; small errors "
      "accumulate. The columns without \"whole run\" are computed in windows of about 1 s (drives) and 2 s "
      "(swing), each with its own initial state."});
  for (const Trace& trace : diagnosis.traces)
    section.blocks.emplace_back(overlay(trace, !diagnosis.extension.empty()));
  return section;
}

report::Section residual_section(const Diagnosis& diagnosis, const configuration::Rig& rig,
                                 const std::vector<Run>& test) {
  report::Section section{.title = "Residual", .blocks = {}};
  section.blocks.emplace_back(report::Paragraph{
      "Measured minus simulated, in windows of about 2 s; the free motion of a wrong initial "
      "state is subtracted. A residual that depends on the horizontal axis shows an effect that "
      "the model lacks. The residual of the extended model should show no dependence."});
  for (const ResidualView& view : residual_views(diagnosis, rig, test))
    for (const Abscissa& abscissa : view.against) {
      report::LinePlot plot{.title = view.column + " against " + abscissa.label,
                            .x_label = abscissa.label,
                            .y_label = "residual [" + view.unit + "]",
                            .x = thinned(abscissa.values),
                            .series = {},
                            .group = ""};
      plot.series.push_back({.name = "simulation",
                             .x = {},
                             .y = thinned(view.baseline),
                             .style = report::Style::points,
                             .upper = {},
                             .color = 1});
      if (!diagnosis.extension.empty())
        plot.series.push_back({.name = "extended",
                               .x = {},
                               .y = thinned(view.extended),
                               .style = report::Style::points,
                               .upper = {},
                               .color = 0});
      section.blocks.emplace_back(std::move(plot));
    }
  return section;
}

report::Section candidates_section(const Diagnosis& diagnosis) {
  report::Section section{.title = "Candidates", .blocks = {}};
  report::Table table{
      .title = "",
      .header = {"candidate", "gain", "p value alone", "resamples", "parameters [95 % interval]"},
      .rows = {}};
  for (const Ranked& ranked : diagnosis.ranking) {
    if (table.rows.size() == kMostCandidates) break;
    // Score test and votes are of single candidates.
    const bool alone = ranked.label.find(" + ") == std::string::npos;
    table.rows.push_back({{ranked.label},
                          {significant(ranked.train_gain, 4)},
                          {alone ? significant(ranked.p_value, 2) : "-"},
                          {alone ? percent(ranked.resampling_frequency) : "-"},
                          {with_intervals(ranked.parameters)}});
  }
  section.blocks.emplace_back(std::move(table));
  section.blocks.emplace_back(report::Paragraph{
      "The deviance is minus twice the log likelihood of the training data plus the penalty of the "
      "parameters; the gain is its decrease. The p value is that of a score test that adds only this "
      "candidate to the base model. Resamples: share of the resamples of the training data that vote for the "
      "candidate."});
  return section;
}

report::Section excitation_section(const Diagnosis& diagnosis) {
  report::Section section{.title = "What these data can show", .blocks = {}};
  report::Table table{
      .title = "",
      .header = {"candidate", "smallest detectable size", "hardly distinguishable from (cosine)"},
      .rows = {}};
  for (const Visibility& visibility : diagnosis.excitation) {
    std::string alike;
    for (const auto& other : visibility.alike)
      alike += (alike.empty() ? "" : ", ") + other.label + " (" + significant(other.cosine, 3) + ")";
    table.rows.push_back({{visibility.label},
                          {visibility.visible ? plain_values(visibility.least) : "not detectable",
                           visibility.visible ? Tone::neutral : Tone::muted},
                          {alike}});
  }
  section.blocks.emplace_back(std::move(table));
  section.blocks.emplace_back(report::Paragraph{
      "The smallest detectable size is the size that the score test finds in 9 of 10 data sets like the "
      "training data, with a false alarm in 1 of 100 data sets without error. It follows from the "
      "training data and their noise model, before any candidate is fitted. Two candidates with a "
      "cosine near 1 or -1 change these data in the same way."});
  return section;
}

report::Section remainder_section(const Diagnosis& diagnosis) {
  report::Section section{.title = "What was not explained", .blocks = {}};
  std::string from;
  for (const std::string& name : diagnosis.remainder.from) from += (from.empty() ? "" : "; ") + name;
  section.blocks.emplace_back(report::Paragraph{
      percent(diagnosis.remainder.predictable_fraction) + " of the residual of the " +
      (diagnosis.extension.empty() ? "simulation" : "extended model") +
      " is predictable (cross-validated). " +
      (from.empty() ? "No variable predicts it." : "Variables that predict it: " + from + ".")});
  return section;
}

std::string without_proposal(Verdict verdict) {
  if (verdict == Verdict::ambiguous)
    return "No motion of the list inside the limits of the rig distinguishes the candidates.";
  if (verdict == Verdict::unknown)
    return "No experiment is proposed, because there are no candidates to distinguish. Record a motion that "
           "varies "
           "only the variables that predict the residual.";
  return "No further experiment is needed.";
}

report::Section next_section(const Diagnosis& diagnosis, const configuration::Rig& rig) {
  report::Section section{.title = "Next experiment", .blocks = {}};
  if (!diagnosis.next_experiment) {
    section.blocks.emplace_back(report::Paragraph{without_proposal(diagnosis.verdict)});
    return section;
  }
  const NextExperiment& next = *diagnosis.next_experiment;
  section.blocks.emplace_back(report::Verdict{.text = next.description, .tone = Tone::neutral});
  section.blocks.emplace_back(report::Paragraph{
      "In this motion the predictions of the refitted candidates differ by " +
      significant(next.separation, 3) +
      " standard deviations of the noise. Run it with: crane run next_experiment.toml --rig " + rig.name +
      ". Add the recording to the training data and repeat the diagnosis."});
  return section;
}

/// Number of hypotheses; held-out runs with their durations.
std::string summary_of(const Diagnosis& diagnosis, const std::vector<Run>& test) {
  std::string held_out;
  for (const Run& run : test)
    held_out += (held_out.empty() ? "" : ", ") + short_name(run.name) + " (" +
                significant(static_cast<double>(run.rows()) * run.period_s, 3) + " s)";
  return std::to_string(diagnosis.ranking.size()) +
         (diagnosis.ranking.size() == 1 ? " hypothesis" : " hypotheses") + " fitted. Held out: " + held_out +
         ".";
}

}  // namespace

report::Page report_page(const Diagnosis& diagnosis, const configuration::Rig& rig,
                         const std::vector<Run>& test) {
  report::Page page{
      .title = "Diagnosis of " + rig.name, .summary = summary_of(diagnosis, test), .sections = {}};
  page.sections.push_back(verdict_section(diagnosis));
  page.sections.push_back(held_out_section(diagnosis));
  page.sections.push_back(candidates_section(diagnosis));
  page.sections.push_back(excitation_section(diagnosis));
  page.sections.push_back(remainder_section(diagnosis));
  page.sections.push_back(next_section(diagnosis, rig));
  page.sections.push_back(residual_section(diagnosis, rig, test));
  if (!diagnosis.notes.empty()) {
    report::Section notes{.title = "Notes on the data", .blocks = {}};
    for (const std::string& note : diagnosis.notes) notes.blocks.emplace_back(report::Paragraph{note});
    page.sections.push_back(std::move(notes));
  }
  return page;
}

}  // namespace crane::diagnosis
