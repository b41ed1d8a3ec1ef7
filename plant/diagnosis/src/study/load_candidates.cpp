#include "study/load_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/candidate_shapes.hpp"
#include "study/swing_lines.hpp"

namespace crane::diagnosis {
namespace {

class LoadBuilder {
 public:
  LoadBuilder(const configuration::Rig& rig, const std::vector<PreparedRun>& runs, const LoadData& data,
              CandidateList& all)
      : rig_{rig}, runs_{runs}, data_{data}, all_{all} {}

  void build() {
    const double m = rig_.plant.load_mass_kg, g = rig_.plant.gravity_mps2;
    const double length = rig_.start.position[plant::kHoist];
    if (data_.driven)
      all_.add(amount("payload_mass", "", "delta_kg", -0.9 * m, 10 * m, 0.05 * m), Changes::both,
               InRigFile::yes);
    all_.add(amount("cable_length", "", "delta_m", -0.7 * length, 2 * length, 0.005), Changes::both,
             InRigFile::yes);
    all_.add(amount("load_linear_drag", "", "coefficient_nspm", 0, 50 * m, 0.02 * m), Changes::load);
    all_.add(amount("load_quadratic_drag", "", "coefficient_ns2pm2", 0, 50 * m, 0.05 * m), Changes::load);
    // On a gantry only the force along the track is visible.
    const double step_n = 0.005 * m * g;
    if (data_.slew || data_.tangential)
      all_.add(turned("steady_wind", "", free_parameter("steady_wind", "force_n", 0, 2 * m, step_n),
                      free_parameter("steady_wind", "direction_rad", -7, 7, 0.02), {}, {{}}),
               Changes::both);
    else if (data_.trolley)
      all_.add(amount("steady_wind", "", "force_n", -2 * m, 2 * m, step_n), Changes::both);
    add_pivot_friction();
    if (data_.trolley) all_.add(amount("jib_tilt", "", "angle_rad", -0.2, 0.2, 0.005), Changes::both);
    add_structures();
    add_swing_sensors();
  }

 private:
  /// The initial values of a resonance differ by about the frequency resolution of 2 s of data. An elastic
  /// cable is not a candidate: no sensor measures its oscillation, and with a free start in every window it
  /// would explain the disturbance of clean data.
  void add_structures() {
    const auto square = [](double hz) { return std::pow(2 * std::numbers::pi * hz, 2); };
    const double most_raised = 0.7 * rig_.start.position[plant::kHoist];
    std::vector<std::vector<double>> jibs, slings;
    for (const double hz : {1.4, 2.0, 2.8, 4.0, 5.6})
      for (const double share : {0.15, 0.6}) jibs.push_back({1 / square(hz), 0.03, share});
    // The measured length reaches to the hook or to the load.
    for (const double hz : {1.2, 1.6, 2.1, 2.6, 3.2, 4.0}) {
      const double sling = rig_.plant.gravity_mps2 / (0.35 * square(hz));
      for (const double raised : {0.0, std::min(sling, most_raised)}) slings.push_back({0.65, sling, raised});
    }
    if (data_.slew)
      all_.add(at_once("jib_flexibility", "",
                       {free_parameter("jib_flexibility", "compliance_s2", 0.0002, 0.1, 0.0005),
                        free_parameter("jib_flexibility", "damping_ratio", 0.001, 0.5, 0.01),
                        free_parameter("jib_flexibility", "jib_share", 0, 0.9, 0.05)},
                       jibs),
               Changes::both);
    Candidate two_cables =
        at_once("double_pendulum", "",
                {free_parameter("double_pendulum", "lower_share", 0.03, 0.85, 0.001),
                 free_parameter("double_pendulum", "lower_length_m", 0.03, 2, 0.0001),
                 free_parameter("double_pendulum", "hook_raised_m", 0, most_raised, 0.001)},
                slings);
    two_cables.ringing_starts = slings_of_lines(most_raised);
    two_cables.ringing_starts_at = [rig = rig_, most_raised](double line_hz) {
      const double own_hz =
          std::sqrt(rig.plant.gravity_mps2 / rig.start.position[plant::kHoist]) / (2 * std::numbers::pi);
      std::vector<std::vector<double>> at_line;
      if (line_hz > own_hz) add_slings(rig, own_hz, line_hz, most_raised, at_line);
      return at_line;
    };
    all_.add(std::move(two_cables), Changes::load);
  }

  /// Two cables whose natural frequencies are the strongest line of the swing and another line. The faster
  /// frequency of a wide swing is lower than that of a small swing, which `wide` corrects.
  [[nodiscard]] std::vector<std::vector<double>> slings_of_lines(double most_raised) const {
    constexpr std::size_t kLines = 3;
    const std::vector<double> lines = swing_lines(runs_, kLines);
    std::vector<std::vector<double>> slings;
    for (std::size_t i = 1; i < lines.size(); ++i)
      for (const double wide : {1.0, 1.05, 1.1})
        add_slings(rig_, std::min(lines[0], lines[i]), wide * std::max(lines[0], lines[i]), most_raised,
                   slings);
    return slings;
  }

  /// Appends two cables with these natural frequencies and the measured length.
  static void add_slings(const configuration::Rig& rig, double slow_hz, double fast_hz, double most_raised,
                         std::vector<std::vector<double>>& slings) {
    for (const double share : {0.4, 0.7, 0.95})
      for (const TwoCables& cables : cables_with(slow_hz, fast_hz, share, rig.plant.gravity_mps2)) {
        const double raised = rig.start.position[plant::kHoist] - cables.upper_m;
        if (raised >= 0 && raised <= most_raised)
          slings.push_back({cables.lower_share, cables.lower_m, raised});
      }
  }

  void add_pivot_friction() {
    const double m = rig_.plant.load_mass_kg, length = rig_.start.position[plant::kHoist];
    const double inertia = m * length * length;
    std::vector<std::string> swing_axes;
    if (data_.radial) swing_axes.emplace_back("radial");
    if (data_.tangential) swing_axes.emplace_back("tangential");
    if (swing_axes.size() == 2) swing_axes.emplace_back("");
    for (const std::string& swing_axis : swing_axes)
      all_.add(
          two_amounts(
              "swing_pivot_friction", swing_axis,
              {free_parameter("swing_pivot_friction", "viscous_nmsprad", 0, 10 * inertia, 0.02 * inertia),
               free_parameter("swing_pivot_friction", "coulomb_nm", 0, inertia, 0.005 * inertia)}),
          Changes::load);
  }

  void add_swing_sensors() {
    // A sensor error changes the measured swing, but not the force of the load on the drives.
    const Changes changes = data_.trolley || data_.slew ? Changes::both : Changes::load;
    std::vector<std::string> swing_axes;
    if (data_.radial) swing_axes.emplace_back("radial");
    if (data_.tangential) swing_axes.emplace_back("tangential");
    for (const std::string& swing_axis : swing_axes) {
      all_.add(amount("swing_offset", swing_axis, "offset_rad", -0.3, 0.3, 0.005), changes);
      all_.add(amount("swing_scale", swing_axis, "factor", 0.5, 2, 0.01), changes);
    }
    if (swing_axes.size() == 2) {
      all_.add(amount("swing_misalignment", "", "angle_rad", -0.6, 0.6, 0.01), changes);
      swing_axes.emplace_back("");
    }
    for (const std::string& swing_axis : swing_axes) {
      all_.add(amount("swing_delay", swing_axis, "delay_s", 0, 0.2, 0.005), changes);
      all_.add(amount("swing_moving_average", swing_axis, "window_s", 0, 0.5, 0.02), changes);
    }
  }

  const configuration::Rig& rig_;
  const std::vector<PreparedRun>& runs_;
  const LoadData& data_;
  CandidateList& all_;
};

}  // namespace

void add_load_candidates(const configuration::Rig& rig, const std::vector<PreparedRun>& runs,
                         const LoadData& data, CandidateList& all) {
  if (data.radial || data.tangential) LoadBuilder(rig, runs, data, all).build();
}

}  // namespace crane::diagnosis
