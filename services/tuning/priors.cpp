#include "tuning/priors.hpp"

#include "crane/plant/coordinates.hpp"
#include "crane/plant/pendulum.hpp"

namespace crane::tuning {

configuration::Rig careful_rig(const configuration::Rig& rig, const Priors& priors) {
  configuration::Rig careful = rig;
  careful.limits.model_checks = false;
  careful.sensing.filter_speed = {};  // its delay would reduce the damping of the position loop
  auto& design = careful.design;
  design.crane.trolley_gain_mps2pv *= 1 + priors.gain_share;
  design.crane.slew_gain_radps2pv *= 1 + priors.gain_share;
  design.crane.load_mass_kg *= priors.payload_low;
  design.swing_observer = false;
  // K_p and K_d are normalised to the load period T: K_p / T^2 = kLoop^2, K_d / T = 2 kLoop, (3.42) of H. M.
  // Omar, Control of Gantry and Tower Cranes.
  const double period_s = plant::swing_period_s(design.crane.gravity_mps2, rig.start.position[plant::kHoist]);
  design.tracking_proportional = kLoop_radps * kLoop_radps * period_s * period_s;
  design.tracking_derivative = 2 * kLoop_radps * period_s;
  for (const std::size_t i : {plant::kTrolley, plant::kSlew}) {
    if (!rig.drives[i].present) continue;
    const double largest_v = priors.friction_share * rig.drives[i].volt_limit_v;
    auto& friction = design.friction[i] = {};
    friction.coulomb_positive_v = friction.coulomb_negative_v = largest_v;
    friction.stiction_positive_v = friction.stiction_negative_v = largest_v;
  }
  return careful;
}

double stiffness_vpu(const configuration::Rig& careful, std::size_t axis) {
  const auto& crane = careful.design.crane;
  const auto& trolley = careful.drives[plant::kTrolley];
  const double x = (trolley.low_limit + trolley.high_limit) / 2;  // all motions have the trolley there
  const double gain = axis == plant::kTrolley
                          ? crane.trolley_gain_mps2pv
                          : crane.slew_gain_radps2pv / (1 + crane.trolley_to_jib_ratio() * x * x);
  return kLoop_radps * kLoop_radps / gain;
}

std::vector<std::string> problems(const configuration::Rig& rig) {
  std::vector<std::string> found;
  const auto add = [&](const std::string& text) { found.push_back(rig.path + ": " + text); };
  if (rig.kind != configuration::RigKind::tower && rig.kind != configuration::RigKind::gantry)
    add("kind: must be tower or gantry");
  if (!rig.drives[plant::kTrolley].present) add("drive.trolley: the tuning needs a trolley drive");
  if (!rig.zones.empty())
    add("zone: the motions of the tuning do not go around no-go zones: clear the middle of the travel, and "
        "remove the zones from a copy of the rig file");
  if (!rig.has_load()) add("plant.load_mass_kg: the tuning needs a load");
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    if (rig.drives[i].present && rig.drives[i].homes())
      add(std::string{"homing."} + plant::kCoordinates[i].name +
          ": home the rig with crane home before the tuning, and start it "
          "with zero = \"start\"");
  return found;
}

}  // namespace crane::tuning
