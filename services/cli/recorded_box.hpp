#pragma once
/// Zones from recorded motion.
#include "crane/configuration/rig.hpp"
#include "crane/topics.hpp"

namespace crane::cli {

/// Box around the recorded positions of the hook, in coordinates of the ground.
class RecordedBox {
 public:
  /// @param suspension_height_m  height of the jib above the ground, from the rig file
  /// @param cable_m  constant cable length of the rig file; 0: the samples contain the measured length
  RecordedBox(double suspension_height_m, double cable_m)
      : suspension_height_m_{suspension_height_m}, cable_m_{cable_m} {}
  /// Extends the box to the hook, at the end of the cable, (2.11) of H. M. Omar, Control of Gantry and Tower
  /// Cranes. Skips and counts a sample with an unknown position or a value that is not finite.
  void add(const msg::State& state);
  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] std::size_t skipped() const { return skipped_; }
  /// @pre samples() > 0
  [[nodiscard]] control::Zone zone(const std::string& name) const;

 private:
  double suspension_height_m_, cable_m_;
  std::size_t samples_ = 0, skipped_ = 0;
  std::array<double, 3> low_{}, high_{};
};

}  // namespace crane::cli
