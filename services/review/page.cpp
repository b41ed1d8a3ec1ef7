/// A review as sentences and as a page.
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

#include "crane/plant/coordinates.hpp"
#include "crane/supervisor/states.hpp"
#include "review/review.hpp"

namespace crane::review {
namespace {

using observation::Note;

const char* name_of(std::size_t axis) { return plant::kCoordinates.at(axis).name; }
/// Unit in which the page shows the position of an axis.
const char* unit_of(std::size_t axis) {
  return plant::kCoordinates.at(axis).unit == std::string_view{"rad"} ? "deg" : "m";
}

template <class... Values>
std::string text(const char* format, Values... values) {
  std::array<char, 512> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

/// "2.34 s after the beginning" of the recording, with the time of day when there is one.
std::string when(const Review& review, std::int64_t at_ns) {
  const double since_s = static_cast<double>(at_ns - review.begin_ns) * 1e-9;
  if (!review.wall_clock) return text("%.2f s", since_s);
  const auto seconds = static_cast<std::time_t>(at_ns / 1'000'000'000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  return text("%.2f s (%02d:%02d:%02d UTC)", since_s, parts.tm_hour, parts.tm_min, parts.tm_sec);
}

std::string state_before(const Review& review, std::int64_t at_ns) {
  const Phase* before = nullptr;
  for (const auto& phase : review.phases)
    if (phase.at_ns < at_ns) before = &phase;
  return before == nullptr ? "" : supervisor::name_of(static_cast<supervisor::State>(before->state));
}

std::string sentence_of(const Review& review, const Note& note) {
  std::string line = note.what + " at " + when(review, note.at_ns) + ", tick " + std::to_string(note.tick) +
                     ", from " + note.from;
  if (const auto before = state_before(review, note.at_ns); !before.empty()) line += ", in state " + before;
  if (!note.explanation.empty()) line += ": " + note.explanation;
  return line + ".";
}

report::Section what_happened(const Review& review) {
  report::Section section{.title = "What happened", .blocks = {}};
  const auto lines = sentences(review);
  const auto* first = review.first_stop();
  section.blocks.emplace_back(report::Verdict{
      .text = lines.front(), .tone = first == nullptr ? report::Tone::good : report::Tone::bad});
  for (std::size_t i = 1; i < lines.size(); ++i) section.blocks.emplace_back(report::Paragraph{lines[i]});
  report::Table next{.title = "What to do next", .header = {"command"}, .rows = {}};
  for (const auto& command : next_commands(review)) next.rows.push_back({{command}});
  section.blocks.emplace_back(std::move(next));
  return section;
}

report::Section timeline(const Review& review) {
  report::Table states{
      .title = "States of the supervisor", .header = {"time", "tick", "state", "cause"}, .rows = {}};
  for (const auto& phase : review.phases)
    states.rows.push_back({{when(review, phase.at_ns)},
                           {std::to_string(phase.tick)},
                           {supervisor::name_of(static_cast<supervisor::State>(phase.state))},
                           {supervisor::name_of(static_cast<supervisor::Cause>(phase.cause))}});
  report::Table notes{.title = "Stops, faults and warnings: the first cause of each, then its consequences",
                      .header = {"fault", "time", "tick", "from", "what", "explanation"},
                      .rows = {}};
  for (std::size_t i = 0; i < review.faults.size(); ++i)
    for (const auto& note : review.faults[i].notes)
      notes.rows.push_back(
          {{std::to_string(i + 1)},
           {when(review, note.at_ns)},
           {std::to_string(note.tick)},
           {note.from},
           {note.what, note.kind == Note::Kind::fault ? report::Tone::bad : report::Tone::neutral},
           {note.explanation}});
  return {.title = "Timeline", .blocks = {std::move(states), std::move(notes)}};
}

report::Section figures(const Review& review) {
  report::Table axes{.title = "Axes",
                     .header = {"axis", "largest speed [unit/s]", "largest distance to the reference [unit]",
                                "largest voltage [V]", "time at the voltage limit [s]"},
                     .rows = {}};
  for (std::size_t i = 0; i < review.axes.size(); ++i) {
    const auto& axis = review.axes[i];
    axes.rows.push_back({{std::string{name_of(i)} + " [" + unit_of(i) + "]"},
                         report::number(axis.largest_speed, 3),
                         report::number(axis.largest_error, 3),
                         report::number(axis.largest_volts, 2),
                         report::number(axis.saturated_s, 2)});
  }
  report::Table traffic{
      .title = "Topics", .header = {"topic", "samples", "lost", "late", "duplicate"}, .rows = {}};
  for (std::size_t i = 0; i < review.topics.size(); ++i) {
    const auto& counts = review.topics[i].counts;
    if (counts.samples == 0) continue;
    const bool loop = topics::kAll[i].every_tick;
    traffic.rows.push_back({{std::string{topics::kAll[i].name}},
                            {std::to_string(counts.samples)},
                            {loop ? std::to_string(counts.lost) : "-",
                             loop && counts.lost > 0 ? report::Tone::bad : report::Tone::neutral},
                            {loop ? std::to_string(counts.late) : "-"},
                            {loop ? std::to_string(counts.duplicate) : "-"}});
  }
  return {.title = "Figures",
          .blocks = {report::Paragraph{text("Largest swing: radial %.2f deg, tangential %.2f deg.",
                                            review.largest_radial_deg, review.largest_tangential_deg)},
                     std::move(axes), std::move(traffic)}};
}

report::Section curves(const Review& review) {
  report::Section section{.title = "Curves", .blocks = {}};
  const auto plot = [&](std::string title, std::string unit, std::vector<report::Series> series) {
    section.blocks.emplace_back(report::LinePlot{.title = std::move(title),
                                                 .x_label = "time [s]",
                                                 .y_label = std::move(unit),
                                                 .x = review.curves.time_s,
                                                 .series = std::move(series),
                                                 .group = "run"});
  };
  const auto line = [](std::string name, std::vector<double> y, bool dashed = false) {
    return report::Series{.name = std::move(name), .x = {}, .y = std::move(y), .upper = {}, .dashed = dashed};
  };
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    plot(name_of(i), unit_of(i),
         {line("measured", review.curves.position[i]), line("reference", review.curves.reference[i], true)});
  plot("swing", "deg",
       {line("radial", review.curves.radial_deg), line("tangential", review.curves.tangential_deg)});
  std::vector<report::Series> volts;
  for (std::size_t i = 0; i < plant::kAxes; ++i) volts.push_back(line(name_of(i), review.curves.volts[i]));
  plot("drives", "V", std::move(volts));
  return section;
}

}  // namespace

std::vector<std::string> sentences(const Review& review) {
  const auto* first = review.first_stop();
  std::vector<std::string> lines;
  if (first == nullptr) {
    lines.emplace_back("Nothing stopped the crane in this recording.");
  } else {
    const auto* cause = review.first_cause();
    lines.push_back("The first cause is " + sentence_of(review, *cause));
    if (!cause->remedy.empty()) lines.push_back("What to do: " + cause->remedy + ".");
    bool after = false;
    for (const auto& note : first->notes)
      if (&note == cause)
        after = true;
      else
        lines.push_back((after ? "Then: " : "Before it: ") + sentence_of(review, note));
  }
  const auto others = review.faults.size() - (first == nullptr ? 0 : 1);
  if (others > 0) lines.push_back(text("The recording contains %zu more faults or warnings.", others));
  if (!review.problems.empty())
    lines.push_back("The file is damaged: " + review.problems.front() +
                    (review.problems.size() > 1 ? ", and more" : "") +
                    ". The review covers the readable part.");
  return lines;
}

std::vector<std::string> next_commands(const Review& review) {
  std::vector<std::string> commands;
  if (review.first_stop() != nullptr)
    commands.insert(commands.end(),
                    {"crane status", "crane supervisor explain --live", "crane reset && crane arm"});
  commands.push_back("crane log export csv " + review.file + " --out run.csv");
  commands.push_back("crane log info " + review.file);
  if (!review.problems.empty()) commands.push_back("crane log repair " + review.file);
  return commands;
}

report::Page page_of(const Review& review) {
  return {.title = "Review of " + std::filesystem::path{review.file}.filename().string(),
          .summary = text("%.1f s.", static_cast<double>(review.end_ns - review.begin_ns) * 1e-9),
          .sections = {what_happened(review), timeline(review), figures(review), curves(review)}};
}

}  // namespace crane::review
