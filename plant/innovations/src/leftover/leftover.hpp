#pragma once
/// Whether what a hypothesis leaves is predictable: ridge regression of the whitened innovations on
/// force-shaped columns, cross-validated over blocks, against sign flips of blocks (Westfall, Young 1993).
#include "candidates/screen.hpp"

namespace crane::innovations {

struct LeftoverGroup {
  std::string name;      ///< "trolley force by speed"
  double gain = 0;       ///< cross-validated nats
  double share = 0;      ///< of the unknown force's variance
  double force_rms = 0;  ///< V or N (m/s^2 without a command)
};
struct Leftover {
  std::vector<LeftoverGroup> groups;  ///< strongest first
  double p_value = 1;                 ///< that the largest gain of all groups is luck
  [[nodiscard]] const LeftoverGroup* strongest() const { return groups.empty() ? nullptr : &groups.front(); }
};
[[nodiscard]] Leftover leftover(const Problem& problem, const Hypothesis& at, std::uint64_t seed);

}  // namespace crane::innovations
