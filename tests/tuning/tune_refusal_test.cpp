/// A tuning that ends early names the reason, and leaves the files of an earlier tuning unchanged.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "../recording/temporary_directory.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/recording/csv.hpp"
#include "experiments/lockstep_run.hpp"
#include "hidden_rig.hpp"
#include "stack/data_files.hpp"
#include "tune_options.hpp"
#include "tuning/lockstep_crane.hpp"
#include "tuning/realtime_crane.hpp"
#include "tuning/tune.hpp"
#include "tuning/wiring.hpp"

namespace crane::tuning {
namespace {

configuration::Rig tower() { return configuration::load_rig(stack::find_rig("virginia_tech_tower")); }

/// @return what() of the refusal; empty when the tuning is not refused
std::string refusal_of(const configuration::Rig& known, CraneAccess& crane, const TuneOptions& options) {
  try {
    (void)tune(known, crane, options);
  } catch (const TuningRefused& refused) {
    return refused.what();
  }
  return "";
}

std::string refusal_of(const HiddenRig& hidden, const TuneOptions& options) {
  LockstepCrane crane{hidden.truth};
  return refusal_of(hidden.known, crane, options);
}

/// A crane that stops in the first motion.
class StoppingCrane final : public CraneAccess {
 public:
  [[nodiscard]] Motion execute(const configuration::Rig& /*rig*/,
                               const experiment::Scenario& /*scenario*/) override {
    throw experiments::RunError("no crane");
  }
};

TEST(TuneFiles, OfAnEarlierTuningStayWhenANewOneFails) {
  const recording::TemporaryDirectory directory;
  std::filesystem::create_directories(directory / "out");
  for (const char* name : {kRigFile, kPageFile})
    recording::put_contents(directory / "out" / name, "of an earlier tuning");
  StoppingCrane crane;
  const auto refusal = refusal_of(tower(), crane, options_for(directory / "out"));
  EXPECT_NE(refusal.find("unchanged, of an earlier tuning: " + (directory / "out" / kRigFile).string()),
            std::string::npos)
      << refusal;
  for (const char* name : {kRigFile, kPageFile})
    EXPECT_EQ(recording::contents_of(directory / "out" / name), "of an earlier tuning");
  EXPECT_TRUE(std::filesystem::exists(directory / "out" / kJsonFile));
}

/// A crane whose motion lacks the ticks 3 and 4, because the program that records it was suspended.
class SuspendedCrane final : public CraneAccess {
 public:
  [[nodiscard]] Motion execute(const configuration::Rig& /*rig*/,
                               const experiment::Scenario& /*scenario*/) override {
    return {{{{"tick", {1, 2, 5}}, {"time_s", {0.01, 0.02, 0.05}}}}, ""};
  }
};

TEST(Tune, RefusesAProbeWithMissingTicks) {
  const recording::TemporaryDirectory directory;
  SuspendedCrane crane;
  const auto refusal = refusal_of(tower(), crane, options_for(directory / "out"));
  EXPECT_NE(refusal.find("2 ticks are missing, the first after tick 2"), std::string::npos) << refusal;
}

/// A crane that does not move; each motion has four rows.
class StuckCrane final : public CraneAccess {
 public:
  [[nodiscard]] Motion execute(const configuration::Rig& rig,
                               const experiment::Scenario& /*scenario*/) override {
    Motion motion{{{{"tick", {1, 2, 3, 4}}, {"time_s", {}}}}, ""};
    for (int row = 0; row < 4; ++row) motion.table.columns[1].values.push_back(row * rig.period_s);
    return motion;
  }
};

TEST(TuneFiles, HaveOnePeriodFromOneRowToTheNextAlsoBetweenTwoMotions) {
  for (const double period_s : {0.005, 0.01, 0.02}) {
    const recording::TemporaryDirectory directory;
    auto rig = tower();
    rig.period_s = period_s;
    StuckCrane crane;
    EXPECT_NE(refusal_of(rig, crane, options_for(directory / "out")).find("does not move"),
              std::string::npos);
    const auto table = recording::read_csv(directory / "out" / kMotionFile);
    const auto& time_s = *table.find("time_s");
    ASSERT_EQ(time_s.size(), 16U);  // four probes
    for (std::size_t row = 0; row < time_s.size(); ++row)
      EXPECT_NEAR(time_s[row], static_cast<double>(row) * period_s, 1e-9) << period_s << " s, row " << row;
  }
}

TEST(Probe, HasTheSameFrictionWithEveryPeriod) {
  constexpr double kRamp_vps = 4, kBreakAway_s = 0.5;
  for (const double period_s : {0.005, 0.01, 0.02}) {
    auto rig = tower();
    rig.period_s = period_s;
    Motion motion;
    motion.table.columns = {{plant::kCoordinates[plant::kTrolley].column, {}},
                            {plant::kCoordinates[plant::kTrolley].command_v, {}}};
    for (const int direction : {1, -1})
      for (int row = 0; row * period_s < 2 * kBreakAway_s; ++row) {
        const double time_s = row * period_s;
        const bool moved = time_s > kBreakAway_s - period_s / 2;
        motion.table.columns[0].values.push_back(moved == (direction > 0) ? 1 : 0);
        motion.table.columns[1].values.push_back(direction * kRamp_vps * time_s);
      }
    const auto finding = examine_probe(motion, rig, plant::kTrolley, false);
    ASSERT_TRUE(finding.moved);
    // Mean of the ramp over the 0.1 s before the motion.
    EXPECT_NEAR(finding.friction_v, kRamp_vps * (kBreakAway_s - 0.05), 1e-9) << period_s << " s";
  }
}

TEST(TuneFiles, NeverReplaceTheRigFileOrTheHiddenRig) {
  const recording::TemporaryDirectory directory;
  const auto file = directory / kRigFile;
  const auto text = "extends = \"" + stack::find_rig("virginia_tech_tower").string() + "\"\n";
  recording::put_contents(file, text);
  StoppingCrane crane;
  auto options = options_for(directory / "");
  EXPECT_THROW((void)tune(configuration::load_rig(file), crane, options), configuration::ConfigurationError);
  options.inputs = {file};
  EXPECT_THROW((void)tune(tower(), crane, options), configuration::ConfigurationError);
  EXPECT_EQ(recording::contents_of(file), text);
}

TEST(TuneFiles, ThatCannotBeWrittenAreRefusedBeforeAnyMotion) {
  const recording::TemporaryDirectory directory;
  std::filesystem::create_directories(directory / "out" / kRigFile);
  StoppingCrane crane;  // a motion would end with TuningRefused
  EXPECT_THROW((void)tune(tower(), crane, options_for(directory / "out")), files::WriteError);
}

TEST(Tune, NamesAnEncoderWithTheWrongSign) {
  for (const std::size_t counter : {plant::kTrolley, plant::kSlew}) {
    const recording::TemporaryDirectory directory;
    auto hidden = hidden_rig(2);
    hidden.truth.encoders[counter].sign *= -1;
    const auto refusal = refusal_of(hidden, options_for(directory / "out"));
    const std::string name = counter == plant::kTrolley ? "trolley" : "slew";
    EXPECT_NE(refusal.find("encoder." + name + ".sign"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(kMotionFile), std::string::npos) << refusal;
    EXPECT_TRUE(std::filesystem::exists(directory / "out" / kMotionFile));
    EXPECT_FALSE(std::filesystem::exists(directory / "out" / kRigFile));
    std::ifstream json{directory / "out" / kJsonFile};
    EXPECT_FALSE(nlohmann::json::parse(json).at("refused").empty());
  }
}

TEST(Tune, NamesASwingEncoderWithTheWrongSign) {
  const recording::TemporaryDirectory directory;
  auto hidden = hidden_rig(1);
  hidden.truth.encoders[plant::kSwingRadial].sign *= -1;
  const auto refusal = refusal_of(hidden, options_for(directory / "out"));
  EXPECT_NE(refusal.find("encoder.swing_radial.sign"), std::string::npos) << refusal;
}

TEST(Tune, RefusesARigWithoutALoadOrWithUnknownPositions) {
  const recording::TemporaryDirectory directory;
  for (const char* name : {"drive_axis", "pendulum", "homing_servo_to_go"}) {
    const auto rig = configuration::load_rig(stack::find_rig(name));
    LockstepCrane crane{rig};
    EXPECT_THROW((void)tune(rig, crane, options_for(directory / "out")), configuration::ConfigurationError)
        << name;
  }
}

TEST(Tune, RefusesARigOnWhichNoLawSettles) {
  const recording::TemporaryDirectory directory;
  const auto hidden = hidden_rig(1);
  auto options = options_for(directory / "out");
  options.candidates = {{.controller = "none", .gains = {}}};  // does not damp the swing
  const auto refusal = refusal_of(hidden, options);
  EXPECT_NE(refusal.find("of 1 combinations"), std::string::npos) << refusal;
  EXPECT_FALSE(std::filesystem::exists(directory / "out" / kRigFile));
  std::ifstream json{directory / "out" / kJsonFile};
  const auto content = nlohmann::json::parse(json);
  EXPECT_FALSE(content.at("refused").empty());
  EXPECT_EQ(content.at("ranking").size(), 1U);
}

/// The processes of a motion read a rig file in the directory of the results.
TEST(Tune, InRealTimeRefusesADirectoryIntoWhichAnotherTuningWrites) {
  const recording::TemporaryDirectory directory;
  RealtimeOptions options;
  options.directory = directory / "";
  const RealtimeCrane first{options};
  EXPECT_THROW(const RealtimeCrane second{options}, files::WriteError);
}

TEST(Tune, RefusesAParameterOutsideThePriors) {
  const recording::TemporaryDirectory directory;
  auto hidden = hidden_rig(1);
  hidden.truth.plant.load_mass_kg = 5 * hidden.known.plant.load_mass_kg;
  const auto refusal = refusal_of(hidden, options_for(directory / "out"));
  EXPECT_NE(refusal.find("load_mass"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find(kJsonFile), std::string::npos) << refusal;
}

}  // namespace
}  // namespace crane::tuning
