#include "crane/diagnosis/moment.hpp"

#include <algorithm>

namespace crane::diagnosis {

Moment between(const Motion& motion, std::size_t row, double share, double period_s) {
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

}  // namespace crane::diagnosis
