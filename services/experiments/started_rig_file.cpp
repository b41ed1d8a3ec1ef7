#include "experiments/started_rig_file.hpp"

#include <array>
#include <fstream>
#include <utility>

#include "crane/recording/csv.hpp"
#include "experiments/lockstep_run.hpp"

namespace crane::experiments {
namespace {

using configuration::Rig;
using recording::shortest;

struct AxisKeys {
  const char* name;
  const char* position;
  const char* speed;
  const char* acceleration;
  const char* jerk;
};
constexpr std::array<AxisKeys, plant::kAxes> kKeys{{
    {"trolley", "trolley_position_m", "reference_speed_mps", "reference_acceleration_mps2",
     "reference_jerk_mps3"},
    {"slew", "slew_angle_rad", "reference_speed_radps", "reference_acceleration_radps2",
     "reference_jerk_radps3"},
    {"hoist", "cable_length_m", "reference_speed_mps", "reference_acceleration_mps2", "reference_jerk_mps3"},
}};

void write_start(std::ostream& out, const Rig& started) {
  out << "\n[start]\n";
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    if (started.drives[i].present || i == plant::kHoist)
      out << kKeys[i].position << " = " << shortest(started.start.position[i]) << '\n';
  out << "swing_radial_rad = " << shortest(started.start.swing_radial_rad) << '\n'
      << "swing_tangential_rad = " << shortest(started.start.swing_tangential_rad) << '\n'
      << "cable_length_offset_m = " << shortest(started.start.cable_length_offset_m) << '\n';
}

void write_plant(std::ostream& out, const Rig& rig, const Rig& started) {
  if (started.plant.load_mass_kg != rig.plant.load_mass_kg)
    out << "\n[plant]\nload_mass_kg = " << shortest(started.plant.load_mass_kg) << '\n';
  if (started.terms.empty() && !rig.terms.empty()) out << "\n[model]\nterms = []\n";
}

void write_references(std::ostream& out, const Rig& rig, const Rig& started) {
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const auto& drive = started.drives[i];
    if (!drive.present || (drive.reference_speed == rig.drives[i].reference_speed &&
                           drive.reference_acceleration == rig.drives[i].reference_acceleration))
      continue;
    out << "\n[drive." << kKeys[i].name << "]\n"
        << kKeys[i].speed << " = " << shortest(drive.reference_speed) << '\n'
        << kKeys[i].acceleration << " = " << shortest(drive.reference_acceleration) << '\n'
        << kKeys[i].jerk << " = " << shortest(drive.reference_jerk) << '\n';
  }
}

void write_sensing(std::ostream& out, const Rig& rig, const Rig& started) {
  const auto& sensing = started.sensing;
  if (sensing.swing_filter_ratio == rig.sensing.swing_filter_ratio &&
      sensing.filter_speed == rig.sensing.filter_speed)
    return;
  out << "\n[sensing]\nswing_filter_ratio = " << shortest(sensing.swing_filter_ratio) << "\nfilter_speed = [";
  const char* separator = "";
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    if (sensing.filter_speed[i]) out << std::exchange(separator, ", ") << '"' << kKeys[i].name << '"';
  out << "]\n";
}

void write_design(std::ostream& out, const Rig& rig, const Rig& started) {
  if (started.design.full_feedback_gain_pm != rig.design.full_feedback_gain_pm)
    out << "\n[controller]\nfull_feedback_gain_pm = " << shortest(started.design.full_feedback_gain_pm)
        << '\n';
  // The controllers keep the nominal load mass.
  if (started.plant.load_mass_kg != rig.plant.load_mass_kg ||
      started.design.crane.load_mass_kg != rig.design.crane.load_mass_kg)
    out << "\n[controller.believes]\nload_mass_kg = " << shortest(started.design.crane.load_mass_kg) << '\n';
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    if (started.drives[i].present && started.design.friction[i].factor != rig.design.friction[i].factor)
      out << "\n[controller.friction." << kKeys[i].name
          << "]\nfactor = " << shortest(started.design.friction[i].factor) << '\n';
}

}  // namespace

void write_started_rig(const std::filesystem::path& file, const Rig& rig, const Rig& started) {
  std::ofstream out{file};
  out << "# " << rig.name << " with the changes of one experiment\n"
      << "extends = \"" << std::filesystem::absolute(rig.path).string() << "\"\n";
  write_start(out, started);
  write_plant(out, rig, started);
  write_references(out, rig, started);
  write_sensing(out, rig, started);
  write_design(out, rig, started);
  if (!out.flush()) throw RunError(file.string() + ": cannot write");
}

}  // namespace crane::experiments
