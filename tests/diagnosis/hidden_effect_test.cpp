/// An effect is hidden in the data by code that shares nothing with the diagnosis; the diagnosis has to find
/// it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "crane/diagnosis/diagnosis.hpp"
#include "truth/truth.hpp"

namespace crane::diagnosis {
namespace {

struct Hidden {
  const char* name;
  const char* axis;
  std::uint64_t seed;
  std::vector<std::string> acceptable;  ///< verdicts
};
void PrintTo(const Hidden& hidden, std::ostream* out) { *out << hidden.name << " " << hidden.axis; }

Diagnosis diagnosed(const truth::Case& request) {
  const truth::Data data = truth::generate(request);
  const runtime::Rig rig = runtime::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml");
  const auto loaded = [&](const std::vector<truth::Run>& runs) {
    std::vector<Run> all;
    for (const truth::Run& run : runs)
      for (Run& piece : load_run(recording::parse_csv(truth::csv(run), run.file), rig, run.file).runs)
        all.push_back(std::move(piece));
    return all;
  };
  return diagnose(rig, loaded(data.training), loaded(data.test));
}

class HiddenEffect : public testing::TestWithParam<Hidden> {};

TEST_P(HiddenEffect, IsNamed) {
  const Hidden& hidden = GetParam();
  truth::Case request;
  request.effects = {{hidden.name, 1.0, hidden.axis}};
  request.seed = hidden.seed;
  const Diagnosis found = diagnosed(request);
  EXPECT_THAT(hidden.acceptable, testing::Contains(name_of(found.verdict))) << found.sentence;
  ASSERT_FALSE(found.causes.empty()) << found.sentence;
  EXPECT_EQ(found.causes[0].name, hidden.name) << found.sentence;
  if (*hidden.axis != '\0' && !found.causes[0].axis.empty()) {
    EXPECT_EQ(found.causes[0].axis, hidden.axis);
  }
  EXPECT_GT(found.held_out.gain, 0) << "the extended model must reproduce the held-out run better";
}

INSTANTIATE_TEST_SUITE_P(EachCause, HiddenEffect,
                         testing::Values(Hidden{"command_delay", "trolley", 7, {"named"}},
                                         Hidden{"cable_length", "", 7, {"parameter"}},
                                         Hidden{"load_quadratic_drag", "", 7, {"named"}},
                                         Hidden{"swing_offset", "radial", 7, {"named"}},
                                         Hidden{"stribeck_friction", "trolley", 7, {"named"}}),
                         [](const auto& tested) { return std::string{tested.param.name}; });

TEST(CleanData, AreSaidToBeRight) {
  for (const std::uint64_t seed : {101, 102, 103}) {
    truth::Case request;
    request.seed = seed;
    const Diagnosis found = diagnosed(request);
    EXPECT_EQ(found.verdict, Verdict::none) << "seed " << seed << ": " << found.sentence;
    EXPECT_TRUE(found.extension.empty());
  }
}

TEST(AnEffectSwitchedOff, IsNotFound) {
  truth::Case request;
  request.effects = {{"command_delay", 0.0, "trolley"}};
  request.seed = 7;
  EXPECT_EQ(diagnosed(request).verdict, Verdict::none);
}

TEST(Diagnosis, RepeatsBitForBit) {
  truth::Case request;
  request.effects = {{"cable_length", 1.0, ""}};
  request.seed = 7;
  request.training_runs = {"rich"};
  request.seconds = 20;
  const Diagnosis first = diagnosed(request), second = diagnosed(request);
  ASSERT_EQ(first.causes.size(), second.causes.size());
  for (std::size_t i = 0; i < first.causes.size(); ++i)
    EXPECT_EQ(first.causes[i].parameters[0].value, second.causes[i].parameters[0].value);
  EXPECT_EQ(first.held_out.gain, second.held_out.gain);
}

TEST(DataInWhichNothingMoves, AreRefused) {
  const runtime::Rig rig = runtime::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml");
  diagnosis::Run still;
  still.name = "still.csv";
  still.period_s = 0.01;
  still.command_v.resize(2000);
  still.cable_m.assign(2000, 1.0);
  for (auto& values : still.measured) values.assign(2000, 0.3);
  EXPECT_THROW((void)diagnose(rig, {still}, {}), DataError);
}

}  // namespace
}  // namespace crane::diagnosis
