#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "cli/diagnosis_data.hpp"

namespace crane::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

fs::path written(const std::string& name, const std::string& text) {
  const fs::path directory = fs::path{testing::TempDir()} / "diagnosis_data";
  fs::create_directories(directory);
  std::ofstream{directory / name} << text;
  return directory / name;
}

/// A pendulum for 2 s at 100 Hz.
std::string swing_csv() {
  std::string text = "time_s,swing_radial_rad\n";
  for (int k = 0; k < 200; ++k)
    text += std::to_string(0.01 * k) + "," + std::to_string(0.1 * std::cos(0.03 * k)) + "\n";
  return text;
}

configuration::Rig pendulum() { return configuration::load_rig(fs::path{CRANE_RIGS} / "pendulum.toml"); }

std::vector<std::string> problems_of(const std::vector<std::string>& train,
                                     const std::vector<std::string>& test) {
  try {
    (void)read_diagnosis_data(train, test, {}, pendulum());
  } catch (const diagnosis::DataError& error) {
    return error.problems();
  }
  return {};
}

TEST(DiagnosisData, KeepsTrainingAndTestApart) {
  const auto a = written("a.csv", swing_csv()), b = written("b.csv", swing_csv());
  const auto data = read_diagnosis_data({a}, {b}, {}, pendulum());
  ASSERT_EQ(data.train.size(), 1U);
  ASSERT_EQ(data.test.size(), 1U);
  EXPECT_EQ(data.train[0].name, a);
  EXPECT_EQ(data.test[0].name, b);
  EXPECT_EQ(data.test[0].rows(), 200U);
}

TEST(DiagnosisData, ReportsTheProblemsOfAllFilesAtOnce) {
  const auto good = written("good.csv", swing_csv());
  const auto degrees = written("degrees.csv", "time_s,swing_radial_rad\n0,1\n0.01,20\n0.02,30\n");
  const auto backwards = written("backwards.csv", "time_s,swing_radial_rad\n0,0.1\n0.02,0.2\n0.01,0.3\n");
  const auto text = written("text.csv", "time_s,swing_radial_rad\n0,abc\n");
  const auto no_recording = written("none.mcap", "time_s\n");
  const auto problems = problems_of({good, degrees, "/nowhere.csv", text}, {backwards, no_recording, good});
  EXPECT_THAT(problems,
              ElementsAre(HasSubstr("degrees.csv: swing_radial_rad: reaches 30"), HasSubstr("/nowhere.csv"),
                          HasSubstr("text.csv:2"), HasSubstr("backwards.csv: time_s: row 3"),
                          HasSubstr("none.mcap"), HasSubstr("good.csv: is given twice")));
}

TEST(UnderControl, KeepsRowsInHoldAndRun) {
  const auto table = recording::parse_csv("time_s,supervisor_state\n0,2\n1,5\n2,6\n3,nan\n4,8\n", "run.csv");
  EXPECT_THAT(*under_control(table).find("time_s"), ElementsAre(1, 2)) << "5 HOLD, 6 RUN";
}

TEST(UnderControl, KeepsAllRowsWithoutASupervisorState) {
  EXPECT_EQ(under_control(recording::parse_csv("time_s\n0\n1\n", "run.csv")).rows(), 2U);
  EXPECT_EQ(under_control(recording::parse_csv("time_s,supervisor_state\n0,nan\n1,nan\n", "run.csv")).rows(),
            2U);
}

}  // namespace
}  // namespace crane::cli
