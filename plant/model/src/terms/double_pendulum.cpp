#include "crane/plant/term.hpp"
#include "terms/load_force.hpp"
#include "tilted_jib.hpp"

namespace crane::plant {
namespace {

/// Direction of a cable and its derivatives, in the slewing frame: e(phi, theta) of (2.11), phi from the
/// vertical.
struct Direction {
  Direction(const motion::Angles<double>& a, double phi_rate, double theta_rate, double turn) {
    unit = {-a.ct * a.sf, a.st, -a.ct * a.cf};
    by_phi = {-a.ct * a.cf, 0, a.ct * a.sf};
    by_theta = {a.st * a.sf, a.ct, a.st * a.cf};
    rate = phi_rate * by_phi + theta_rate * by_theta;
    rate_over_ground = rate + turn * Eigen::Vector3d{-unit.y(), unit.x(), 0};
    const Eigen::Vector3d by_phi_phi{a.ct * a.sf, 0, a.ct * a.cf}, by_phi_theta{a.st * a.cf, 0, -a.st * a.sf};
    bend = phi_rate * phi_rate * by_phi_phi + 2 * phi_rate * theta_rate * by_phi_theta -
           theta_rate * theta_rate * unit;
  }
  Eigen::Vector3d unit, by_phi, by_theta;  ///< e, its derivatives by the angles
  Eigen::Vector3d rate, rate_over_ground;  ///< e' in the slewing frame, and relative to the ground
  Eigen::Vector3d bend;                    ///< e'' in the slewing frame without phi'' and theta''
};

/// Tensions of both cables divided by the mass of the hook, m/s^2.
struct Tensions {
  double upper = 0, lower = 0;
};

/// The inner coordinates are the angles of the lower cable relative to the upper cable: at their initial
/// value 0 the load is in line with the upper cable. Both cables are taut. The tensions neglect the
/// acceleration of the suspension point and of the hoist along the cable.
class DoublePendulum final : public Term {
 public:
  explicit DoublePendulum(const TermSetting& s)
      : lower_share_(s.parameters.at("lower_share")),
        lower_length_m_(s.parameters.at("lower_length_m")),
        hook_raised_m_(s.parameters.at("hook_raised_m")) {}

  void change_parameters(Parameters& crane) const noexcept override {
    crane.load_mass_kg *= 1 - lower_share_;
  }
  [[nodiscard]] Displacement rest_displacement(const Parameters& /*crane*/) const noexcept override {
    return {.cable_m = lower_share_ > 0 ? -hook_raised_m_ : 0};
  }
  [[nodiscard]] std::size_t inner_coordinates() const noexcept override { return lower_share_ > 0 ? 2 : 0; }

  /// The lower cable pulls at the hook. Newton's law of both masses, subtracted: l e_2'' = T_1 / m_1 e_1 -
  /// (...) e_2, projected on the derivatives of e_2, which are orthogonal to e_2 and to each other.
  void add_inner_motion(const Parameters& crane, const State& s, const motion::Angles<double>& cable,
                        const Inner* inner, Forces& sum, InnerEquation* equations) const noexcept override {
    if (lower_share_ == 0) return;
    const double turn = s.slew_radps;
    const Direction upper{cable, s.radial_radps, s.tangential_radps, turn};
    const Direction lower{
        level_angles(crane, s.radial_rad + inner[0].position, s.tangential_rad + inner[1].position),
        s.radial_radps + inner[0].rate, s.tangential_radps + inner[1].rate, turn};
    const Tensions pull = tensions(crane, s, upper, lower);
    add_generalised(
        load_jacobian(crane, s, cable).transpose() * (crane.load_mass_kg * pull.lower * lower.unit), sum);

    const Eigen::Vector3d& e = lower.unit;
    const Eigen::Vector3d rotation = 2 * turn * Eigen::Vector3d{-lower.rate.y(), lower.rate.x(), 0} -
                                     turn * turn * Eigen::Vector3d{e.x(), e.y(), 0};
    const Eigen::Vector3d turning{-e.y(), e.x(), 0};  // times slew''
    const Eigen::Vector3d bending = pull.upper / lower_length_m_ * upper.unit - rotation - lower.bend;
    const double phi_squares = lower.by_phi.squaredNorm();
    equations[0] = {.free = lower.by_phi.dot(bending) / phi_squares,
                    .by_radial = -1,
                    .by_slew = -lower.by_phi.dot(turning) / phi_squares};
    equations[1] = {
        .free = lower.by_theta.dot(bending), .by_slew = -lower.by_theta.dot(turning), .by_tangential = -1};
  }

 private:
  /// Sines and cosines of the angles in the slewing frame.
  [[nodiscard]] static motion::Angles<double> level_angles(const Parameters& crane, double radial_rad,
                                                           double tangential_rad) {
    return tilted::level(crane, motion::Angles<double>{radial_rad, tangential_rad});
  }
  /// Newton's law of both masses along the cables, whose lengths do not change:
  ///   T_1 / m_1 - c T_2 / m_1 = g cos_1 + L |e_1'|^2,   T_2 / m_1 = mu (c T_1 / m_1 + l |e_2'|^2)
  /// with c = e_1 . e_2 and the share mu of the lower mass.
  [[nodiscard]] Tensions tensions(const Parameters& crane, const State& state, const Direction& upper,
                                  const Direction& lower) const {
    const double c = upper.unit.dot(lower.unit);
    const double upper_pull =
        -crane.gravity_mps2 * upper.unit.z() + state.cable_m * upper.rate_over_ground.squaredNorm();
    const double lower_pull = lower_share_ * lower_length_m_ * lower.rate_over_ground.squaredNorm();
    const double tension = (upper_pull + c * lower_pull) / (1 - lower_share_ * c * c);
    return {.upper = tension, .lower = lower_share_ * c * tension + lower_pull};
  }
  double lower_share_, lower_length_m_, hook_raised_m_;
};

}  // namespace

TermKind double_pendulum() {
  return {
      .name = "double_pendulum",
      .equation =
          "hook (1 - mu) m at L - u, load mu m at l below: l e_2'' = T_1 e_1 / m_1 - (T_2 / m_1 + T_2 / "
          "m_2) e_2 "
          "with the tensions that keep both lengths; F = T_2 along the lower cable on the hook",
      .effect =
          "hook and load are two masses on two cables; the equations are exact while the suspension point is "
          "at rest",
      .acts_on = ActsOn::structure,
      .axes = {""},
      .parameters = {{"lower_share", "1", 0, 0, 0.9, "mu, share of the load mass that hangs below the hook"},
                     {"lower_length_m", "m", 0.3, 0.02, 10, "l, distance from the hook to the load"},
                     {"hook_raised_m", "m", 0, 0, 10,
                      "u, distance from the hook down to the end of the measured cable length; 0: the "
                      "measured length ends at "
                      "the hook; l: at the load"}},
      .example = {"double_pendulum", "", {{"lower_share", 0.4}, {"lower_length_m", 0.25}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> {
        return std::make_unique<DoublePendulum>(s);
      }};
}

}  // namespace crane::plant
