#include "crane/diagnosis/candidate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "replay/travel.hpp"
#include "study/candidate_shapes.hpp"
#include "study/known_friction.hpp"
#include "study/load_candidates.hpp"

namespace crane::diagnosis {
namespace {

using plant::TermSetting;

InRigFile in_rig_file(bool known) { return known ? InRigFile::yes : InRigFile::no; }

/// Travel of the support [m or rad] below which an error of its sensor is not visible.
constexpr double kResting = 0.005;
/// Longest wavelength of a friction and of a ripple, as a multiple of the travel. The travel contains at
/// least half a wave of a friction, the slope beside a tight spot, and a whole wave of a ripple. A smaller
/// part of a wave does not show that a force is periodic: a spring at one end of the travel has the same
/// form.
constexpr double kLongestWave = 2, kLongestRipple = 1;

class Builder {
 public:
  Builder(const configuration::Rig& rig, const std::vector<PreparedRun>& runs) : rig_(rig), runs_(runs) {}

  std::vector<Candidate> build() {
    const auto measured = [&](Output output) {
      return std::any_of(runs_.begin(), runs_.end(), [&](const PreparedRun& r) { return r.run.has(output); });
    };
    const auto driven = [&](Output output) {
      return std::any_of(runs_.begin(), runs_.end(),
                         [&](const PreparedRun& r) { return r.run.has(output) && r.run.commanded[output]; });
    };
    for (const auto& [axis, output, scale] :
         {std::tuple{"trolley", kTrolleyPosition, 1.0}, std::tuple{"slew", kSlewAngle, 2.0}}) {
      if (driven(output)) add_axis(axis, output, scale);
      if (!driven(output) && measured(output) && travelled(output) > kResting) add_support_sensor(axis);
    }
    if (rig_.has_load())
      add_load_candidates(rig_, runs_,
                          {.trolley = measured(kTrolleyPosition),
                           .slew = measured(kSlewAngle),
                           .driven = driven(kTrolleyPosition) || driven(kSlewAngle),
                           .radial = measured(kRadialSwing),
                           .tangential = measured(kTangentialSwing)},
                          all_);
    return all_.take();
  }

 private:
  void add_force(GoesWith law, Candidate candidate, InRigFile known = InRigFile::no) {
    candidate.law = law;
    all_.add(std::move(candidate), Changes::drive, known);
  }

  void add_axis(const std::string& axis, Output output, double scale) {
    const KnownFriction known = known_friction(rig_, axis);
    // Where only one of model and axis sticks, a small change of force or friction has no effect: large
    // probes.
    const double c = known.least_coulomb_v;
    std::vector<std::vector<double>> levels, sides, offsets, gains, inertias, excesses;
    if (c > 0) {
      excesses = {{0.3 * c, 0.06, 2}, {0.6 * c, 0.06, 2}, {0.45 * c, 0.12, 2}};
      levels = {{-0.15 * c}, {-0.3 * c}, {-0.6 * c}, {0.3 * c}};
      for (const double share : {-0.3, -0.1, -0.04, 0.04, 0.1, 0.3}) {
        sides.push_back({share * c, 0});
        offsets.push_back({share * c});
      }
      gains = {{0.8}, {1.15}, {1.4}};
      inertias = {{0.75}, {0.87}, {1.25}};
    }
    add_force(GoesWith::speed, reaching(amount("coulomb_friction", axis, "level_v", -c, 5, 0.02), levels),
              in_rig_file(known.present));
    add_force(GoesWith::speed, amount("viscous_friction", axis, "vspm", -known.least_viscous, 50, 0.05),
              in_rig_file(known.present && known.least_viscous > 0));
    add_force(GoesWith::speed,
              reaching(two_amounts("direction_asymmetry", axis,
                                   {free_parameter("direction_asymmetry", "coulomb_v", -3, 3, 0.02),
                                    free_parameter("direction_asymmetry", "viscous_vspm", -20, 20, 0.05)}),
                       sides));
    add_force(GoesWith::speed,
              reaching(shaped("stribeck_friction", axis,
                              free_parameter("stribeck_friction", "excess_v", 0, 5, 0.05),
                              {free_parameter("stribeck_friction", "decay_speed", 0.003, 0.5, 0.002),
                               free_parameter("stribeck_friction", "exponent", 1, 2, 0.1)},
                              {{0.01, 2}, {0.03, 2}, {0.08, 2}, {0.2, 2}, {0.02, 1}, {0.06, 1}}),
                       excesses));
    add_tight_spots(axis, output);
    add_ripple(axis, output);
    add_force(GoesWith::position,
              two_amounts("position_force", axis,
                          {free_parameter("position_force", "stiffness_vpm", -100, 100, 0.05),
                           free_parameter("position_force", "offset_v", -5, 5, 0.02)}));
    all_.add(amount("gear_friction", axis, "share", 0, 0.9, 0.02), Changes::drive);
    all_.add(reaching(amount("motor_gain", axis, "factor", 0.2, 5, 0.01), gains), Changes::drive,
             InRigFile::yes);
    Candidate inertia = reaching(amount("drive_inertia", axis, "factor", 0.2, 5, 0.01), inertias);
    inertia.rarer_than = "motor_gain";
    all_.add(std::move(inertia), Changes::drive, InRigFile::yes);
    all_.add(reaching(amount("command_offset", axis, "offset_v", -3, 3, 0.02), offsets), Changes::drive);
    all_.add(amount("command_dead_zone", axis, "width_v", 0, 3, 0.02), Changes::drive);
    add_limits(axis, output);
    // A small delay does not describe the effect of a long one.
    all_.add(reaching(amount("command_delay", axis, "delay_s", 0, 0.3, 0.005),
                      {{0.02}, {0.035}, {0.05}, {0.07}, {0.1}, {0.14}, {0.2}}),
             Changes::drive);
    all_.add(shaped("actuator_lag", axis, free_parameter("actuator_lag", "time_constant_s", 0, 0.5, 0.01),
                    {free_parameter("actuator_lag", "second_s", 0, 0.5, 0.01)}, {{0}}),
             Changes::drive);
    add_gap(axis, output, scale);
    all_.add(amount("position_scale", axis, "factor", 0.5, 2, 0.01), Changes::both);
    all_.add(amount("position_drift", axis, "rate", -0.3, 0.3, 0.002), Changes::both);
  }

  /// A limit with no effect at `high`, where no slope shows its effect: the fit begins at `settings`.
  static Candidate limit(const std::string& cause, const std::string& axis, const std::string& name,
                         double low, double high, const std::vector<std::vector<double>>& settings) {
    FreeParameter p = free_parameter(cause, name, low, high, 0.05 * low);
    p.null = p.high;
    return at_once(cause, axis, {p}, settings);
  }

  /// Limits of the amplifier, below the largest command and below its largest change from row to row.
  void add_limits(const std::string& axis, Output output) {
    double largest_v = 0, fastest_vps = 0;
    for (const PreparedRun& prepared : runs_) {
      const std::vector<plant::PerAxis>& command_v = prepared.run.command_v;
      for (std::size_t k = 0; k < command_v.size(); ++k) {
        largest_v = std::max(largest_v, std::abs(command_v[k][output]));
        if (k > 0)
          fastest_vps = std::max(
              fastest_vps, std::abs(command_v[k][output] - command_v[k - 1][output]) / prepared.run.period_s);
      }
    }
    if (!(largest_v > 0)) return;
    std::vector<std::vector<double>> limits, rates;
    for (const double share : {0.9, 0.75, 0.6, 0.45, 0.3}) limits.push_back({share * largest_v});
    all_.add(limit("command_saturation", axis, "limit_v", 0.05 * largest_v, largest_v, limits),
             Changes::drive);
    // A ramp of the whole command that takes longer hardly follows the command.
    constexpr double kLongestRamp_s = 5;
    const double slowest_vps = largest_v / kLongestRamp_s;
    for (double rate = 0.5 * fastest_vps; rate > slowest_vps; rate *= 0.5) rates.push_back({rate});
    if (rates.empty()) return;
    all_.add(limit("command_rate_limit", axis, "rate_vps", slowest_vps, fastest_vps, rates), Changes::drive);
  }

  /// Errors of the sensor of a drive without a command are visible in the swing only.
  void add_support_sensor(const std::string& axis) {
    all_.add(amount("position_scale", axis, "factor", 0.5, 2, 0.01), Changes::load);
    all_.add(amount("position_drift", axis, "rate", -0.3, 0.3, 0.002), Changes::load);
  }

  /// The motion of the body behind the gap depends on its inertia more than on the width of the gap.
  void add_gap(const std::string& axis, Output output, double scale) {
    const double carriage = rig_.plant.trolley_mass_kg / rig_.plant.trolley_inertia_kg;
    const double share = output == kTrolleyPosition ? std::clamp(carriage, 0.05, 0.85) : 0.6;
    std::vector<std::vector<double>> settings;
    const FreeParameter gap_width = free_parameter("backlash", "gap", 0.0002, 0.05, 0.001);
    std::vector<double> gaps;
    for (double width = 0.001 * scale; width < gap_width.high; width *= std::numbers::sqrt2)
      gaps.push_back(width);
    for (const double width : gaps)
      for (const double guide : {0.1, 0.6}) settings.push_back({width, guide, share, 1});
    Candidate gap = at_once("backlash", axis,
                            {gap_width, free_parameter("backlash", "guide_deceleration", 0, 2, 0.1),
                             free_parameter("backlash", "driven_share", 0.02, 0.9, 0.05),
                             free_parameter("backlash", "known_guide_share", 0, 1, 0.1)},
                            settings);
    gap.parameters.back().often_at_bound = true;
    for (const double width : gaps)
      for (const double guide : {0.1, 0.3, 0.8})
        for (const double of_axis : {0.2, 0.4, 0.65}) gap.rough_starts.push_back({width, guide, of_axis, 1});
    gap.rough = true;
    gap.law = GoesWith::jumps;
    all_.add(std::move(gap), Changes::both);
  }

  void add_tight_spots(const std::string& axis, Output output) {
    std::vector<std::vector<double>> shapes;
    const double travel = travelled(output), middle = travel_of(runs_, output).middle();
    const FreeParameter wavelength = free_parameter("position_dependent_friction", "wavelength", 0.1 * travel,
                                                    kLongestWave * travel, 0.01 * travel);
    for (const double share : {1.6, 0.8, 0.4})
      for (int place = 0; place < 4 && share * travel > wavelength.low; ++place)
        shapes.push_back({share * travel, middle + 0.25 * place * share * travel});
    if (shapes.empty()) return;
    Candidate spots = shaped(
        "position_dependent_friction", axis,
        free_parameter("position_dependent_friction", "amplitude_v", 0, 5, 0.02),
        {wavelength, free_parameter("position_dependent_friction", "tight_at", -100, 100, 0.01 * travel)},
        shapes);
    spots.friction_waves = true;
    add_force(GoesWith::position, std::move(spots));
  }

  void add_ripple(const std::string& axis, Output output) {
    Candidate ripple =
        at_once("torque_ripple", axis,
                {free_parameter("torque_ripple", "amplitude_v", 0, 5, 0.02),
                 free_parameter("torque_ripple", "phase_rad", -7, 7, 0.02),
                 free_parameter("torque_ripple", "period", 1e-3, kLongestRipple * travelled(output), 1e-4)},
                {});
    ripple.waves = true;
    add_force(GoesWith::position, std::move(ripple));
  }

  /// Travel of an axis in all runs, at least 1 mm or 1 mrad, so that no range of parameters is empty.
  [[nodiscard]] double travelled(Output output) const {
    return std::max(travel_of(runs_, output).width(), 1e-3);
  }

  const configuration::Rig& rig_;
  const std::vector<PreparedRun>& runs_;
  CandidateList all_;
};

}  // namespace

std::vector<Candidate> candidates_for(const configuration::Rig& rig, const std::vector<PreparedRun>& runs) {
  return Builder(rig, runs).build();
}

}  // namespace crane::diagnosis
