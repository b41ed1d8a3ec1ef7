#include "crane/experiment/picture.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "crane/plot/plane.hpp"
#include "signals.hpp"

namespace crane::experiment {
namespace {

using plot::draw_plane;
using plot::PictureError;
using plot::Plane;
using plot::PlaneMap;
using testing::HasSubstr;

const Caption kCaption{"virginia_tech_tower", "gain_scheduling_partial", "maneuver_1"};

std::vector<Sample> run() {
  return sampled(20, [](double t) {
    Sample s;
    s.position = {0.25 + 0.75 * step_response(t - 0.5, 0.7, 2), 0.01 * std::sin(t), 1};
    s.reference = {t < 0.5 ? 0.25 : 1.0, 0, std::nan("")};
    s.swing_radial_rad = 0.1 * std::exp(-t) * std::sin(3.1 * t);
    s.drive_v[0] = 3 * std::exp(-t);
    return s;
  });
}

class Picture : public testing::Test {
 protected:
  Picture() {
    std::string pattern = (std::filesystem::temp_directory_path() / "crane_picture_test_XXXXXX").string();
    EXPECT_NE(::mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  ~Picture() override { std::filesystem::remove_all(directory_); }

  void draw(const std::string& name, const Caption& caption = kCaption) const {
    const std::vector<Sample> samples = run();
    draw_maneuver(directory_ / name, caption, samples, trolley_move(0.5),
                  evaluate(samples, trolley_move(0.5)));
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream in{directory_ / name, std::ios::binary};
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string error_of(const std::string& name) const {
    try {
      draw(name);
    } catch (const PictureError& error) {
      return error.what();
    }
    return "no PictureError";
  }

  std::filesystem::path directory_;
};

TEST_F(Picture, IsTheSameSvgForTheSameRun) {
  draw("a.svg");
  draw("b.svg");
  EXPECT_THAT(text_of("a.svg"), HasSubstr("</svg>"));
  EXPECT_EQ(text_of("a.svg"), text_of("b.svg"));
}

TEST_F(Picture, NamesRigControllerScenarioUnitsAndSettlingTime) {
  draw("a.svg");
  const std::string svg = text_of("a.svg");
  for (const char* text : {"virginia_tech_tower", "gain_scheduling_partial", "maneuver_1", "trolley [m]",
                           "slew [deg]", "swing [deg]", "drive [V]", "settled after"})
    EXPECT_THAT(svg, HasSubstr(text));
}

TEST_F(Picture, IsAPngWhenAsked) {
  draw("a.png");
  EXPECT_THAT(text_of("a.png"), testing::StartsWith("\x89PNG"));
}

TEST_F(Picture, TakesNamesLiterally) {
  draw("it's.svg", {"O'Brien's; system 'false'", "$HOME `id`", "a_b^{c} \"d\""});
  EXPECT_THAT(text_of("it's.svg"),
              testing::AllOf(HasSubstr("O'Brien's; system 'false'"), HasSubstr("a_b^{c}")));
}

TEST_F(Picture, NamesTheProblem) {
  EXPECT_THAT(error_of("a.jpg"), HasSubstr("must end in .svg or .png"));
  EXPECT_THAT(error_of("no/such/a.svg"), HasSubstr("no/such"));
  EXPECT_TRUE(std::filesystem::is_empty(directory_));
}

TEST_F(Picture, NamesTheRemedyWhenGnuplotIsMissing) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  const std::string error = error_of("a.svg");
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(error, "gnuplot is not installed; install it with: apt-get install gnuplot-nox");
}

TEST_F(Picture, OfAPlaneIsTheSameEveryTimeAndNamesItsMarks) {
  const Plane plane{.x = {"K", -1, 1, 5},
                    .y = {"tau", 0, 1, 4},
                    .largest = 0.5,
                    .contour_step = 0.1,
                    .marks = {{"printed", 0.2, 0.4}}};
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) values.push_back(0.03 * i - 0.1);
  const std::vector<PlaneMap> maps{{"right-most pair", values}, {"all pairs", values}};
  draw_plane(directory_ / "a.svg", "damping", plane, maps);
  draw_plane(directory_ / "b.svg", "damping", plane, maps);
  const std::string a = text_of("a.svg");
  EXPECT_EQ(a, text_of("b.svg"));
  for (const char* text : {"right-most pair", "all pairs", "printed", "damping", "tau"})
    EXPECT_THAT(a, HasSubstr(text));
  EXPECT_THROW(draw_plane(directory_ / "c.svg", "damping", plane, {{"short", {1, 2}}}), PictureError);
  EXPECT_THROW(draw_plane(directory_ / "c.svg", "damping", plane, {}), PictureError);
}

}  // namespace
}  // namespace crane::experiment
