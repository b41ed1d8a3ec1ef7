#include "crane/diagnosis/report.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "crane/files/complete_file.hpp"
#include "crane/plant/term.hpp"
#include "crane/simulator/simulated_board.hpp"
#include "report/residual_view.hpp"

namespace crane::diagnosis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kRows = 600;

configuration::Rig rig_of(const std::string& name) {
  return configuration::load_rig(std::filesystem::path{CRANE_RIGS} / (name + ".toml"));
}

/// A gantry whose simulation has 95 % of the trolley's motion.
struct Example {
  Example() {
    run.name = "held_out.csv";
    run.period_s = 0.01;
    for (std::size_t k = 0; k < kRows; ++k) {
      const double t = 0.01 * static_cast<double>(k);
      run.command_v.push_back({std::sin(t), 0, 0});
      run.measured[kTrolleyPosition].push_back(1 + 0.5 * std::sin(3 * t));
      run.measured[kRadialSwing].push_back(0.1 * std::cos(2 * t));
      run.cable_m.push_back(1.5);
    }
    diagnosis.verdict = Verdict::ambiguous;
    diagnosis.sentence = "These data do not distinguish command_delay (trolley) from actuator_lag.";
    diagnosis.causes = {{"command_delay", "trolley", {{"delay_s", "s", 0.03, 0.001}}, 1e-5, 0.6}};
    diagnosis.ambiguous_with = {"actuator_lag"};
    diagnosis.next_experiment = NextExperiment{"shaking_trolley", "Shake it.", 7.5, "description = \"x\"\n"};
    diagnosis.held_out.baseline_rms = {{"trolley_position_m", 0.012}};
    diagnosis.held_out.extended_rms = {{"trolley_position_m", 0.004}};
    diagnosis.held_out.gain = 0.67;
    diagnosis.held_out.gain_ci95 = {0.6, 0.7};
    diagnosis.remainder = {0.08, {"speed of the trolley"}};
    diagnosis.ranking = {{"command_delay (trolley)", {{"delay_s", "s", 0.03, 0.001}}, 120, 1e-5, 0.6}};
    diagnosis.extension = {{"command_delay", "trolley", {{"delay_s", 0.03}}}};
    for (const Output output : {kTrolleyPosition, kRadialSwing}) {
      Trace trace{run.name, kOutputNames[output], {}, run.measured[output], {}, {}};
      for (std::size_t k = 0; k < kRows; ++k) trace.time_s.push_back(0.01 * static_cast<double>(k));
      for (const double value : trace.measured) trace.baseline.push_back(0.95 * value);
      trace.extended = trace.measured;
      diagnosis.traces.push_back(trace);
    }
  }
  Run run;
  Diagnosis diagnosis;
};

TEST(ReportJson, HasTheFieldsOfTheContract) {
  const auto json = to_json(Example{}.diagnosis);
  EXPECT_EQ(json["verdict"], "ambiguous");
  EXPECT_EQ(json["causes"][0]["name"], "command_delay");
  EXPECT_EQ(json["causes"][0]["axis"], "trolley");
  EXPECT_EQ(json["causes"][0]["parameters"]["delay_s"]["value"], 0.03);
  EXPECT_EQ(json["causes"][0]["parameters"]["delay_s"]["std"], 0.001);
  EXPECT_EQ(json["causes"][0]["parameters"]["delay_s"]["unit"], "s");
  EXPECT_EQ(json["causes"][0]["p_value"], 1e-5);
  EXPECT_EQ(json["causes"][0]["resampling_frequency"], 0.6);
  EXPECT_EQ(json["ambiguous_with"][0], "actuator_lag");
  EXPECT_EQ(json["next_experiment"]["name"], "shaking_trolley");
  EXPECT_EQ(json["held_out"]["baseline_rms"]["trolley_position_m"], 0.012);
  EXPECT_EQ(json["held_out"]["extended_rms"]["trolley_position_m"], 0.004);
  EXPECT_EQ(json["held_out"]["gain"], 0.67);
  EXPECT_EQ(json["held_out"]["gain_ci95"][1], 0.7);
  EXPECT_EQ(json["residual"]["predictable_fraction"], 0.08);
  EXPECT_EQ(json["residual"]["from"][0], "speed of the trolley");
  EXPECT_TRUE(json.contains("runtime_s"));
}

TEST(ReportJson, OfAnEmptyDiagnosisHasTheSameFields) {
  const auto full = to_json(Example{}.diagnosis), empty = to_json(Diagnosis{});
  for (const auto& [key, value] : full.items()) EXPECT_TRUE(empty.contains(key)) << key;
  EXPECT_EQ(empty["verdict"], "none");
  EXPECT_TRUE(empty["next_experiment"].is_null());
  EXPECT_TRUE(empty["causes"].is_array());
}

/// Parameters of the term between default and bound.
plant::TermSetting some(const plant::TermKind& kind) {
  plant::TermSetting setting{std::string{kind.name}, std::string{kind.axes.front()}, {}};
  for (const plant::TermParameter& p : kind.parameters) {
    const double end = p.high > p.default_value ? p.high : p.low;
    setting.parameters[std::string{p.name}] =
        p.default_value + 0.01 * std::clamp(end - p.default_value, -3.0, 3.0);
  }
  return setting;
}

std::vector<std::array<std::int32_t, bridge::kCounters>> driven(const configuration::Rig& rig) {
  simulator::SimulatedRig simulated;
  simulated.parameters = rig.plant;
  simulated.terms = rig.terms;
  simulator::SimulatedBoard board{simulated};
  bridge::Outputs outputs;
  outputs.brake_release = {true, true, true};
  outputs.drive_v = {1.7, 1.3, 0};
  std::vector<std::array<std::int32_t, bridge::kCounters>> counts;
  for (std::int64_t tick = 0; tick < 60; ++tick) {
    board.advance_to(tick * 10'000'000);
    counts.push_back(board.read().raw_counts);
    outputs.watchdog_level = !outputs.watchdog_level;
    board.write(outputs);
  }
  return counts;
}

class ExtendedRigTerm : public testing::TestWithParam<std::string> {};

TEST_P(ExtendedRigTerm, LoadsAndRunsInTheSimulator) {
  configuration::Rig rig = rig_of("virginia_tech_tower");
  // A rig file states the friction of a drive once.
  std::erase_if(rig.terms, [](const plant::TermSetting& term) { return term.name == GetParam(); });
  Diagnosis diagnosis;
  diagnosis.extension = {some(*plant::find_term(GetParam()))};
  const auto extended = configuration::parse_rig(extended_rig_text(rig, diagnosis), "/nowhere/extended.toml");
  ASSERT_EQ(extended.terms.size(), rig.terms.size() + 1);
  EXPECT_EQ(extended.terms.back().name, GetParam());
  EXPECT_EQ(extended.terms.back().axis, diagnosis.extension[0].axis);
  EXPECT_EQ(extended.terms.back().parameters, diagnosis.extension[0].parameters) << "to the last bit";
  EXPECT_EQ(extended.name, "virginia_tech_tower_extended");
  rig.terms.push_back(diagnosis.extension[0]);
  EXPECT_EQ(driven(extended), driven(rig));
}

std::vector<std::string> term_names() {
  std::vector<std::string> names;
  for (const plant::TermKind& kind : plant::term_kinds()) names.emplace_back(kind.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(All, ExtendedRigTerm, testing::ValuesIn(term_names()),
                         [](const auto& entry) { return entry.param; });

TEST(ExtendedRig, EqualsTheRigWithoutCauses) {
  const auto rig = rig_of("virginia_tech_tower_ideal");
  const auto extended =
      configuration::parse_rig(extended_rig_text(rig, Diagnosis{}), "/nowhere/extended.toml");
  EXPECT_TRUE(extended.terms.empty());
  EXPECT_EQ(extended.start.position, rig.start.position);
}

TEST(ResidualViews, RemoveOnlyTheFreeMotionOfAStart) {
  Example example;
  auto& trolley = example.diagnosis.traces[0];
  // Two windows; a straight line in each is a wrong start.
  for (std::size_t k = 0; k < kRows; ++k) {
    trolley.baseline[k] = trolley.measured[k] - 0.3 - 0.02 * static_cast<double>(k);
    trolley.extended[k] = trolley.measured[k] - 0.001 * std::sin(0.3 * static_cast<double>(k));
  }
  const auto views = residual_views(example.diagnosis, rig_of("gantry"), {example.run});
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[0].unit, "mm");
  EXPECT_EQ(views[1].unit, "mrad");
  double before = 0, after = 0;
  for (std::size_t k = 0; k < kRows; ++k) {
    before = std::max(before, std::abs(views[0].baseline[k]));
    after = std::max(after, std::abs(views[0].extended[k]));
  }
  EXPECT_LT(before, 1e-8);
  EXPECT_NEAR(after, 1, 0.2);
  std::vector<std::string> labels;
  for (const Abscissa& abscissa : views[0].against) {
    labels.push_back(abscissa.label);
    EXPECT_EQ(abscissa.values.size(), kRows) << abscissa.label;
  }
  EXPECT_THAT(labels, ElementsAre("time [s]", "trolley position [m]", "trolley speed [m/s]", "swing [rad]",
                                  "swing rate [rad/s]", "trolley command [V]"));
}

TEST(ReportPage, HasVerdictGainCandidatesRemainderAndNextExperiment) {
  const Example example;
  const std::string html = report::to_html(report_page(example.diagnosis, rig_of("gantry"), {example.run}));
  for (const char* text : {"These data do not distinguish command_delay", "0.670 [0.600, 0.700]",
                           "0.03 ± 0.001 s", "Candidates", "8 % of the residual of the extended model",
                           "speed of the trolley", "Shake it.", "against trolley command [V]"})
    EXPECT_THAT(html, HasSubstr(text));
  EXPECT_THAT(html, Not(HasSubstr("http://"))) << "nothing comes from a network";
}

std::string page_of(const Example& example) {
  return report::to_html(report_page(example.diagnosis, rig_of("gantry"), {example.run}));
}

TEST(ReportPage, ClaimsNoUnprovenGain) {
  Example example;
  EXPECT_THAT(page_of(example), HasSubstr("error is smaller by 67 % (95 % interval 60 % to 70 %)"));
  example.diagnosis.held_out.gain_ci95 = {-0.1, 0.7};
  EXPECT_THAT(page_of(example),
              HasSubstr("error is not significantly smaller: gain 67 % (95 % interval -10 %"));
  example.diagnosis.held_out.gain = -0.03;
  example.diagnosis.held_out.gain_ci95 = {-0.07, -0.002};
  EXPECT_THAT(page_of(example), HasSubstr("error is larger by 3 %"));
}

TEST(ReportPage, NamesTheHeldOutRunsAndTheGainOfEachColumn) {
  const std::string html = page_of(Example{});
  EXPECT_THAT(html, HasSubstr("1 hypothesis fitted. Held out: held_out.csv (6 s)."));
  EXPECT_THAT(html, HasSubstr(">0.667<")) << "trolley: 12 mm before, 4 mm after";
}

TEST(ReportPage, DistinguishesRunsOfTheSameFileName) {
  Example example;
  example.run.name = "/data/monday/recording.mcap";
  for (Trace& trace : example.diagnosis.traces) trace.run = example.run.name;
  const std::string html = page_of(example);
  EXPECT_THAT(html, HasSubstr("Held out: monday/recording.mcap (6 s)."));
  EXPECT_THAT(html, HasSubstr("trolley_position_m, monday/recording.mcap"));
}

TEST(ReportPage, WritesLargeNumbersInFull) {
  Example example;
  example.diagnosis.ranking[0].train_gain = 204431.2;
  EXPECT_THAT(page_of(example), HasSubstr(">204431<"));
}

TEST(ReportPage, GivesResamplesOfSingleCandidatesOnly) {
  Example example;
  example.diagnosis.ranking = {{"motor_gain (trolley)", {{"factor", "1", 1.1, 0.01}}, 9, 0.5, 0.77},
                               {"motor_gain (trolley) + jib_tilt", {}, 9, 0.5, 0}};
  const std::string html = page_of(example);
  EXPECT_THAT(html, HasSubstr("factor 1.1 [1.08, 1.12]<")) << "a number without a unit has none";
  EXPECT_THAT(html, HasSubstr("77 %"));
  EXPECT_THAT(html, Not(HasSubstr(">0 %")));
}

TEST(ReportFiles, AreWrittenAndRemoveAnEarlierProposal) {
  const auto directory = std::filesystem::path{testing::TempDir()} / "diagnosis_report";
  std::filesystem::create_directories(directory);
  Example example;
  const auto rig = rig_of("gantry");
  write_report(directory, example.diagnosis, rig, {example.run});
  draw_diagnosis(directory, example.diagnosis, rig, {example.run});
  for (const char* name :
       {"report.json", "report.html", "extended.toml", "next_experiment.toml", "overlay_1.svg",
        "residual_trolley_position_m.svg", "residual_swing_radial_rad.svg"})
    EXPECT_TRUE(std::filesystem::is_regular_file(directory / name)) << name;
  EXPECT_EQ(configuration::load_rig(directory / "extended.toml").terms.size(), 1U);
  example.diagnosis.next_experiment.reset();
  write_report(directory, example.diagnosis, rig, {example.run});
  EXPECT_FALSE(std::filesystem::exists(directory / "next_experiment.toml"));
  EXPECT_THROW(write_report(directory / "nowhere", example.diagnosis, rig, {}), files::WriteError);
}

}  // namespace
}  // namespace crane::diagnosis
