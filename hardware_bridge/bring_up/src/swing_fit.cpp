#include "crane/bring_up/swing_fit.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "crane/plant/pendulum.hpp"

namespace crane::bring_up {

double SwingFit::amplitude_rad() const { return std::hypot(cosine_rad, sine_rad); }

double SwingFit::at(double time_s, double frequency_radps) const {
  const double phase = frequency_radps * time_s;
  return offset_rad + cosine_rad * std::cos(phase) + sine_rad * std::sin(phase);
}

double swing_frequency_radps(const configuration::Rig& rig) {
  return plant::swing_radps(rig.plant.gravity_mps2, rig.start.position[plant::kHoist]);
}

SwingFit fit_swing(std::span<const Sample> record, std::size_t counter, double frequency_radps) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& sample : record) {
    const double phase = frequency_radps * sample.time_s;
    const Eigen::Vector3d row{1, std::cos(phase), std::sin(phase)};
    normal += row * row.transpose();
    right += row * sample.coordinate[counter];
  }
  const Eigen::Vector3d found = normal.ldlt().solve(right);
  return {found[0], found[1], found[2]};
}

SwingFit expected_swing(std::span<const Sample> motion, std::size_t axis, double lever_m_per_unit,
                        double cable_m, double frequency_radps) {
  SwingFit swing;
  for (std::size_t k = 1; k < motion.size(); ++k) {
    const double jump_rad =
        (motion[k].coordinate[axis] - motion[k - 1].coordinate[axis]) * lever_m_per_unit / cable_m;
    const double phase = frequency_radps * (motion[k].time_s + motion[k - 1].time_s) / 2;
    swing.cosine_rad += jump_rad * std::cos(phase);
    swing.sine_rad += jump_rad * std::sin(phase);
  }
  return swing;
}

double share_of(const SwingFit& expected, const SwingFit& before, const SwingFit& after) {
  const double size = expected.amplitude_rad();
  if (size == 0) return 0;
  return ((after.cosine_rad - before.cosine_rad) * expected.cosine_rad +
          (after.sine_rad - before.sine_rad) * expected.sine_rad) /
         (size * size);
}

}  // namespace crane::bring_up
