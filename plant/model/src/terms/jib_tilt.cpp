#include <cmath>

#include "crane/plant/term.hpp"

namespace crane::plant {
namespace {

class JibTilt final : public Term {
 public:
  explicit JibTilt(const TermSetting& s) : angle_rad_(s.parameters.at("angle_rad")) {}

  void change_parameters(Parameters& crane) const noexcept override {
    if (angle_rad_ == 0) return;
    const double total_rad = std::atan2(crane.tilt_sine, crane.tilt_cosine) + angle_rad_;
    crane.tilt_sine = std::sin(total_rad);
    crane.tilt_cosine = std::cos(total_rad);
  }

 private:
  double angle_rad_;
};

}  // namespace

TermKind jib_tilt() {
  return {.name = "jib_tilt",
          .equation =
              "the jib is inclined by a, the slew axis is vertical: gravity g {-sin(a), 0, -cos(a)} and "
              "angular velocity gamma' {sin(a), 0, cos(a)} in the jib frame",
          .effect =
              "the jib or the rail of a gantry is not level; the load at rest has phi = a relative to the "
              "normal of the jib",
          .acts_on = ActsOn::parameters,
          .axes = {""},
          .parameters = {{"angle_rad", "rad", 0, -0.3, 0.3,
                          "a, inclination of the jib; positive: the tip is raised"}},
          .example = {"jib_tilt", "", {{"angle_rad", 0.01}}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<JibTilt>(s); }};
}

}  // namespace crane::plant
