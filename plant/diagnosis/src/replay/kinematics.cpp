#include "crane/diagnosis/kinematics.hpp"

#include <algorithm>

namespace crane::diagnosis {

Kinematics between(const Motion& motion, std::size_t row, double share, double period_s) {
  if (motion.position.empty()) return {};
  const std::size_t next = std::min(row + 1, motion.position.size() - 1);
  const double p0 = motion.position[row], p1 = motion.position[next];
  const double r0 = motion.rate[row], r1 = motion.rate[next];
  const double s = share, s2 = s * s, s3 = s2 * s;
  return {.position = (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * period_s * r0 +
                      (3 * s2 - 2 * s3) * p1 + (s3 - s2) * period_s * r1,
          .rate = (6 * s2 - 6 * s) * (p0 - p1) / period_s + (3 * s2 - 4 * s + 1) * r0 + (3 * s2 - 2 * s) * r1,
          .acceleration = (1 - s) * motion.acceleration[row] + s * motion.acceleration[next]};
}

std::vector<MeasuredKinematics> mid_step_kinematics(const std::array<Motion, kOutputs>& motion,
                                                    const Motion& cable, int steps, double period_s) {
  std::vector<MeasuredKinematics> all;
  const std::size_t rows = cable.position.size();
  all.reserve(rows * static_cast<std::size_t>(steps));
  for (std::size_t row = 0; row + 1 < rows; ++row)
    for (int step = 0; step < steps; ++step) {
      const double share = (step + 0.5) / steps;
      MeasuredKinematics& at = all.emplace_back();
      for (const Output output : kAllOutputs)
        at.output[output] = between(motion[output], row, share, period_s);
      at.cable = between(cable, row, share, period_s);
    }
  return all;
}

}  // namespace crane::diagnosis
