#include "hidden_rig.hpp"

#include <random>
#include <sstream>

#include "crane/plant/coordinates.hpp"
#include "stack/data_files.hpp"

namespace crane::tuning {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_{seed} {}
  double uniform(double low, double high) {
    // 53 bits: std::uniform_real_distribution differs between libraries.
    const double share = static_cast<double>(engine_() >> 11U) / 9007199254740992.0;
    return low + (high - low) * share;
  }

 private:
  std::mt19937_64 engine_;
};

constexpr std::array kNames{"trolley", "slew"};

void add_drive(configuration::Rig& rig, std::size_t axis, const TrueDrive& drive) {
  (axis == 0 ? rig.plant.trolley_gain_mps2pv : rig.plant.slew_gain_radps2pv) = drive.gain;
  rig.terms.push_back({"drive_friction",
                       kNames[axis],
                       {{"coulomb_positive_v", drive.coulomb_positive_v},
                        {"coulomb_negative_v", drive.coulomb_negative_v},
                        {"viscous_positive_vspm", drive.viscous_positive_vspm},
                        {"viscous_negative_vspm", drive.viscous_negative_vspm}}});
  rig.terms.push_back({"command_delay", kNames[axis], {{"delay_s", drive.delay_s}}});
}

TrueDrive drawn_drive(Draw& draw, const configuration::Rig& known, std::size_t axis) {
  const double gain = axis == 0 ? known.plant.trolley_gain_mps2pv : known.plant.slew_gain_radps2pv;
  const double volts = known.drives[axis].volt_limit_v;
  TrueDrive drive;
  drive.gain = gain * draw.uniform(0.6, 1.4);
  const double friction_v = volts * draw.uniform(0, 0.4);
  const double asymmetry = draw.uniform(-0.3, 0.3);
  drive.coulomb_positive_v = std::min(friction_v * (1 + asymmetry), 0.4 * volts);
  drive.coulomb_negative_v = std::min(friction_v * (1 - asymmetry), 0.4 * volts);
  const double viscous = axis == 0 ? 3.0 : 0.5;
  drive.viscous_positive_vspm = draw.uniform(0, viscous);
  drive.viscous_negative_vspm = draw.uniform(0, viscous);
  drive.delay_s = draw.uniform(0, 2) * known.period_s;
  return drive;
}

/// The rig as its file gives it: reading computes the values of the design that follow from others.
configuration::Rig reread(const configuration::Rig& rig) {
  return configuration::parse_rig(configuration::to_toml(rig), rig.path);
}

std::string text_of(const HiddenRig& rig) {
  std::ostringstream text;
  text << rig.known.name << ": cable " << rig.cable_m << " m, load " << rig.load_mass_kg << " kg, rest "
       << rig.rest_angle_rad[0] << ' ' << rig.rest_angle_rad[1] << " rad";
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!rig.known.drives[axis].present) continue;
    const auto& d = rig.drives[axis];
    text << "; " << kNames[axis] << " gain " << d.gain << ", friction " << d.coulomb_positive_v << ' '
         << d.coulomb_negative_v << " V, " << d.viscous_positive_vspm << ' ' << d.viscous_negative_vspm
         << " V s, delay " << 1000 * d.delay_s << " ms";
  }
  return text.str();
}

}  // namespace

HiddenRig hidden_rig(std::uint64_t seed) {
  constexpr double kLargestRest_rad = 0.0349;  // 2 degrees
  Draw draw{seed};
  HiddenRig hidden;
  hidden.known = configuration::load_rig(stack::find_rig(seed % 2 == 0 ? "virginia_tech_tower" : "gantry"));
  auto& known = hidden.known;
  known.board = "simulated";
  known.drives[plant::kHoist].low_limit = 0.3;
  known.drives[plant::kHoist].high_limit = 2.4;
  known = reread(known);
  hidden.truth = known;
  auto& truth = hidden.truth;
  truth.terms.clear();
  hidden.cable_m = draw.uniform(0.4, 2);
  hidden.load_mass_kg = truth.plant.load_mass_kg = known.plant.load_mass_kg * draw.uniform(0.5, 2);
  truth.start.cable_length_offset_m = hidden.cable_m - known.start.position[plant::kHoist];
  const bool tower = known.kind == configuration::RigKind::tower;
  for (std::size_t swing = 0; swing < (tower ? 2U : 1U); ++swing) {
    hidden.rest_angle_rad[swing] = draw.uniform(-kLargestRest_rad, kLargestRest_rad);
    truth.terms.push_back({"swing_offset",
                           swing == 0 ? "radial" : "tangential",
                           {{"offset_rad", hidden.rest_angle_rad[swing]}}});
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!known.drives[axis].present) continue;
    hidden.drives[axis] = drawn_drive(draw, known, axis);
    add_drive(truth, axis, hidden.drives[axis]);
  }
  auto& ideal = hidden.ideal = truth;
  ideal.start.position[plant::kHoist] = hidden.cable_m;
  ideal.start.cable_length_offset_m = 0;
  ideal.design.cable_length_m = hidden.cable_m;
  ideal.design.crane = ideal.plant;
  std::erase_if(ideal.terms, [](const auto& term) { return term.name == "swing_offset"; });
  for (std::size_t swing = 0; swing < 2; ++swing)
    ideal.encoders[plant::kSwingRadial + swing].rest_angle_rad = hidden.rest_angle_rad[swing];
  for (std::size_t axis = 0; axis < 2; ++axis) {
    auto& friction = ideal.design.friction[axis] = {};
    const auto& drive = hidden.drives[axis];
    friction.coulomb_positive_v = friction.stiction_positive_v = drive.coulomb_positive_v;
    friction.coulomb_negative_v = friction.stiction_negative_v = drive.coulomb_negative_v;
    friction.viscous_positive_vspm = drive.viscous_positive_vspm;
    friction.viscous_negative_vspm = drive.viscous_negative_vspm;
    friction.factor = 1;
  }
  ideal = reread(ideal);
  hidden.description = text_of(hidden);
  return hidden;
}

}  // namespace crane::tuning
