#include "crane/experiment/comparison.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "crane/experiment/variant.hpp"

namespace crane::experiment {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

ComparedRun run_of(const std::string& scenario, const std::string& variant, const std::string& controller,
                   std::optional<double> settling_time_s) {
  Metrics metrics;
  metrics.settling_time_s = settling_time_s;
  metrics.effort_v2s = {1.25, 2.5, 0};
  std::vector<Sample> samples(5);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].time_s = 0.01 * static_cast<double>(i);
  return {scenario, variant, controller, "a, \"b\" | c", "", metrics, samples};
}

ComparedRun stopped(ComparedRun run, const std::string& why) {
  run.stopped_because = why;
  run.metrics.reset();
  return run;
}

const std::vector<ComparedRun> kRuns{run_of("m1", "ideal", "p", 3.4),
                                     run_of("m1", "ideal", "q", std::nullopt),
                                     run_of("m1", "short_cable", "p", 3.5),
                                     stopped(run_of("m1", "short_cable", "q", 0), "OVERSPEED, at 3 \"m/s\"")};

std::vector<std::string> split_lines(const std::string& text) {
  std::istringstream in{text};
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string csv() {
  std::ostringstream out;
  write_comparison_csv(out, kRuns);
  return out.str();
}

std::string markdown() {
  std::ostringstream out;
  write_comparison_markdown(out, kRuns);
  return out.str();
}

TEST(Comparison, CsvHasARowPerRunAndAColumnPerFigure) {
  const auto lines = split_lines(csv());
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_THAT(lines[0], testing::StartsWith("scenario,variant,controller,stopped_because,settling_time_s,"));
  EXPECT_THAT(lines[0], HasSubstr("trolley_effort_v2s"));
  EXPECT_THAT(lines[1], testing::StartsWith("m1,ideal,p,,3.4,"));
  EXPECT_THAT(lines[2], testing::StartsWith("m1,ideal,q,,,"));
}

TEST(Comparison, AStoppedRunIsARowWithItsReason) {
  const auto lines = split_lines(csv());
  const auto figures = static_cast<std::size_t>(std::count(lines[0].begin(), lines[0].end(), ',')) - 3;
  EXPECT_EQ(lines[4], "m1,short_cable,q,\"OVERSPEED, at 3 \"\"m/s\"\"\"" + std::string(figures, ','));
  EXPECT_THAT(markdown(), HasSubstr("OVERSPEED, at 3 \"m/s\" |\n"));
  EXPECT_EQ(comparison_json(kRuns)[3].at("settling_time_s"), nullptr);
}

TEST(Comparison, MarkdownHasControllersAsRowsAndVariantsAsColumns) {
  EXPECT_THAT(split_lines(markdown()),
              testing::IsSupersetOf({"| controller | ideal |           short_cable |",
                                     "| p          |  3.40 |                  3.50 |",
                                     "| q          |     - | OVERSPEED, at 3 \"m/s\" |"}));
}

TEST(Comparison, StatesRatiosToTheLeastTimeOfTheScenario) {
  EXPECT_THAT(markdown(), Not(HasSubstr("least time")));
  auto runs = kRuns;
  for (auto& run : runs) run.least_settling_time_s = 1.7;
  std::ostringstream out;
  write_comparison_summary(out, runs);
  EXPECT_THAT(out.str(), HasSubstr("## m1: settling time / least time of 1.700 s"));
  EXPECT_THAT(split_lines(out.str()), testing::Contains("| p          |  2.00 |                  2.06 |"));
}

TEST(Comparison, PageOverlaysAllControllersOfAScenarioAndVariant) {
  const auto page = comparison_page(kRuns, "rig");
  ASSERT_EQ(page.sections.size(), 3U);
  EXPECT_EQ(page.sections[1].title, "m1, ideal");
  std::vector<std::string> titles;
  for (const auto& block : page.sections[1].blocks) {
    const auto* plot = std::get_if<report::LinePlot>(&block);
    if (plot == nullptr) continue;
    titles.push_back(plot->title);
    ASSERT_GE(plot->series.size(), 2U);
    EXPECT_EQ(plot->series[0].name, "p");
    EXPECT_EQ(plot->series[1].name, "q");
    EXPECT_THAT(plot->series[0].x, ElementsAre(0, 0.02, 0.04)) << "every second tick";
  }
  EXPECT_THAT(titles, ElementsAre("Trolley position", "Slew angle", "Radial swing", "Tangential swing",
                                  "Trolley drive", "Slew drive"));
  const std::string html = report::to_html(page);
  EXPECT_EQ(html, report::to_html(comparison_page(kRuns, "rig")));
  EXPECT_THAT(html, HasSubstr("OVERSPEED, at 3 &quot;m/s&quot;"));
}

TEST(Comparison, DrawsASharedReferenceOnce) {
  const auto page = comparison_page(kRuns, "rig");
  int references = 0;
  for (const auto& block : page.sections[1].blocks)
    if (const auto* plot = std::get_if<report::LinePlot>(&block))
      for (const auto& series : plot->series) references += series.name.starts_with("reference") ? 1 : 0;
  EXPECT_EQ(references, 2) << "one of the trolley, one of the slew axis";
}

}  // namespace
}  // namespace crane::experiment
