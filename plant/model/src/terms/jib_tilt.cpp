#include <cmath>

#include "crane/plant/term.hpp"
#include "terms/load_force.hpp"

namespace crane::plant {
namespace {

class JibTilt final : public Term {
 public:
  explicit JibTilt(const TermSetting& s)
      : along_(std::sin(s.parameters.at("angle_rad"))), lost_(1 - std::cos(s.parameters.at("angle_rad"))) {}

  void add_force(const Parameters& crane, const State& state, Forces& sum) const noexcept override {
    const double g = crane.gravity_mps2;
    sum.trolley_n -= crane.trolley_mass_kg * g * along_;
    add_load_force(state, crane.load_mass_kg * g * Eigen::Vector3d{-along_, 0, lost_}, sum);
  }

 private:
  double along_, lost_;  // shares of gravity: towards the tower, and decrease perpendicular to the jib
};

}  // namespace

TermKind jib_tilt() {
  return {.name = "jib_tilt",
          .equation =
              "g = {-g sin(a), 0, -g cos(a)} in the jib frame: F_x = -M_j g sin(a) on the trolley, "
              "m g {-sin(a), 0, 1 - cos(a)} on the load",
          .source = "the jib is not level; the load at rest has phi = a relative to the normal of the jib",
          .acts_on = ActsOn::load,
          .axes = {""},
          .parameters = {{"angle_rad", "rad", 0, -0.3, 0.3,
                          "a, inclination of the jib; positive: the tip is raised"}},
          .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<JibTilt>(s); }};
}

}  // namespace crane::plant
