// An observer of the emulated rig answers the questions. The calibration finds signs, scales and position for
// any wiring.
#include "crane/bring_up/calibration.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "bench.hpp"

namespace crane::bring_up::test {
namespace {

/// Observes the crane and answers correctly.
class Onlooker {
 public:
  Onlooker(Bench& bench, bool measures) : bench_{bench}, measures_{measures} {}

  CalibrationOptions options() {
    return {.ask = [this](const std::string& question) { return answer(question); }};
  }
  std::string answer(const std::string& question) {
    EXPECT_EQ(bench_.rig().drive_v(), (std::array<double, kDrives>{})) << question;
    bench_.expect_safe();
    ++questions_;
    const auto& truth = bench_.rig().crane().truth();
    const std::array<double, kDrives> now{truth.trolley_m, truth.slew_rad, truth.cable_m};
    if (question.find("[y/n]") != std::string::npos) {
      axis_ = question.find("trolley") != std::string::npos ? 0
              : question.find("slew") != std::string::npos  ? 1
                                                            : 2;
      moved_ = now[axis_] - before_[axis_];
      before_ = now;
      return moved_ > 0 ? "y" : "n";
    }
    if (!measures_) return "";
    return std::to_string(question.find("how far") == 0 ? std::abs(moved_) : now[axis_]);
  }
  [[nodiscard]] int questions() const { return questions_; }

 private:
  Bench& bench_;
  bool measures_;
  std::size_t axis_ = 0;
  double moved_ = 0;
  int questions_ = 0;
  std::array<double, kDrives> before_ = bench_.stated().start.position;
};

/// All combinations of wrong signs of one axis and its swing.
TEST(Calibration, FindsEverySign) {
  for (int signs = 0; signs < 8; ++signs)
    for (const std::size_t axis : {0U, 1U}) {
      auto wired = tower();
      wired.drives[axis].sign = (signs & 1) != 0 ? -1 : 1;
      wired.encoders[axis].sign = (signs & 2) != 0 ? -1 : 1;
      wired.encoders[kDrives + axis].sign = (signs & 4) != 0 ? -1 : 1;
      Bench bench{tower(), wired};
      Onlooker onlooker{bench, false};
      const auto found = calibrate(bench.session(), onlooker.options());
      EXPECT_EQ(onlooker.questions(), 9);
      for (std::size_t i = 0; i < kDrives; ++i)
        EXPECT_EQ(found.drive_sign[i], wired.drives[i].sign) << signs << i;
      for (std::size_t i = 0; i < kCounters; ++i)
        EXPECT_EQ(found.encoder_sign[i], wired.encoders[i].sign) << signs << ' ' << i;
    }
}

TEST(Calibration, FindsScalesAndPositionsFromATape) {
  auto wired = tower();
  for (std::size_t i = 0; i < kDrives; ++i)
    wired.encoders[i].counts_per_unit *= 0.9 + 0.1 * static_cast<double>(i);
  wired.encoders[1].sign = -1;
  Bench bench{tower(), wired};
  Onlooker onlooker{bench, true};
  const auto found = calibrate(bench.session(), onlooker.options());
  const auto& truth = bench.rig().crane().truth();
  const std::array<double, kDrives> place{truth.trolley_m, truth.slew_rad, truth.cable_m};
  for (std::size_t i = 0; i < kDrives; ++i) {
    // The observer reads some centimetres on the tape to a micrometre.
    EXPECT_NEAR(found.counts_per_unit[i] / wired.encoders[i].counts_per_unit, 1, 1e-4);
    EXPECT_NEAR(found.position[i], place[i], 1e-6);
  }
}

TEST(Calibration, WaitsForALoadThatHangsStill) {
  auto wired = tower();
  wired.start.swing_radial_rad = 0.02;
  Bench bench{tower(), wired};
  int questions = 0;
  CalibrationOptions options{.ask = [&](const std::string& question) {
    EXPECT_NE(question.find("the load swings"), std::string::npos);
    return ++questions < 3 ? "y" : "n";
  }};
  EXPECT_THROW(std::ignore = calibrate(bench.session(), options), Ended);
  EXPECT_EQ(questions, 3);
  bench.expect_safe();
}

/// An encoder that was zeroed with a swinging load has an offset.
TEST(Calibration, RefusesAZeroFromALoadThatSwungWhenTheBoardWasOpened) {
  auto wired = tower();
  wired.start.swing_radial_rad = 0.02;
  wired.terms.push_back({.name = "load_linear_drag", .axis = "", .parameters = {{"coefficient_nspm", 8.0}}});
  Bench bench{tower(), wired};
  CalibrationOptions options{.ask = [](const std::string&) { return "y"; }};
  try {
    std::ignore = calibrate(bench.session(), options);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string{error.what()}.find("rad from the zero"), std::string::npos) << error.what();
  }
}

TEST(Calibration, RepeatsAQuestionUntilTheAnswerIsValid) {
  Bench bench{tower(), tower()};
  Onlooker onlooker{bench, true};
  int nonsense = 0;
  auto options = onlooker.options();
  options.ask = [&](const std::string& question) -> std::string {
    if (nonsense++ % 2 == 0) return question.find("[y/n]") != std::string::npos ? "perhaps" : "3 cm";
    return onlooker.answer(question);
  };
  const auto found = calibrate(bench.session(), options);
  EXPECT_EQ(found.drive_sign, (std::array<int, kDrives>{1, 1, 1}));
}

TEST(Calibration, EndsWhenABrakeDoesNotHoldOrAnEncoderDoesNotFollow) {
  const auto lines = tower().wiring.drives[1];
  Bench loose{
      tower(), tower(), {.outputs_on = static_cast<std::uint16_t>(1U << (lines.brake_release_output - 16))}};
  Onlooker first{loose, false};
  EXPECT_THROW(std::ignore = calibrate(loose.session(), first.options()), std::runtime_error);
  loose.end_session();
  loose.expect_safe();

  auto wired = tower();
  wired.encoders[0].channel = 7;
  Bench dead{tower(), wired};
  Onlooker second{dead, false};
  EXPECT_THROW(std::ignore = calibrate(dead.session(), second.options()), std::runtime_error);
  EXPECT_EQ(second.questions(), 0);
  dead.end_session();
  dead.expect_safe();
}

class CalibrationFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& text) const { std::ofstream{file_} << text; }
  static Calibration some() {
    return {
        .drive_sign = {1, -1, 1},
        .encoder_sign = {-1, 1, 1, 1, -1},
        .counts_per_unit = {600000, 57295.77951308232, 1 / 3.0 * 1e5, 3819.718634205488, 3819.718634205488},
        .position = {0.41, -0.2, 0.9}};
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("crane_calibration_" + std::to_string(::getpid()));
  std::filesystem::path file_ = folder_ / "calibrated.toml";
};

TEST_F(CalibrationFile, IsARigFileWithTheCalibratedValues) {
  const auto calibration = some();
  write(calibration_file(tower(), calibration, file_));
  const auto rig = configuration::load_rig(file_);
  EXPECT_EQ(rig.name, tower().name);
  for (std::size_t i = 0; i < kDrives; ++i) {
    EXPECT_EQ(rig.drives[i].sign, calibration.drive_sign[i]);
    EXPECT_EQ(rig.start.position[i], calibration.position[i]);
  }
  for (std::size_t i = 0; i < kCounters; ++i) {
    EXPECT_EQ(rig.encoders[i].sign, calibration.encoder_sign[i]);
    EXPECT_EQ(rig.encoders[i].counts_per_unit, calibration.counts_per_unit[i]);
  }
  EXPECT_NO_THROW(require_own_file(tower(), file_)) << "a rig may be calibrated again";
}

TEST_F(CalibrationFile, DoesNotOverwriteTheFileOfAnotherRig) {
  write(calibration_file(tower(), some(), file_));
  auto other = tower();
  other.name = "the_other_crane";
  try {
    std::ignore = calibration_file(other, some(), file_);
    FAIL();
  } catch (const configuration::ConfigurationError& error) {
    EXPECT_NE(std::string{error.what()}.find("another rig than the_other_crane"), std::string::npos);
  }
  EXPECT_THROW(require_own_file(tower(), tower().path), configuration::ConfigurationError);
  write("these are notes");
  EXPECT_THROW(require_own_file(tower(), file_), configuration::ConfigurationError);
}

TEST_F(CalibrationFile, RefusesAPositionOutsideTheLimits) {
  auto calibration = some();
  calibration.position[0] = 3;
  EXPECT_THROW(std::ignore = calibration_file(tower(), calibration, file_),
               configuration::ConfigurationError);
}

}  // namespace
}  // namespace crane::bring_up::test
