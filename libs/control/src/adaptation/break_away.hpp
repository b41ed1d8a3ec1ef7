#pragma once
/// Excess of the break-away level over the Coulomb level of one axis, learnt when the axis leaves the zero
/// band (docs/adaptation.md).
#include <array>
#include <cstddef>

#include "crane/control/law.hpp"

namespace crane::control::adaptation {

class BreakAway {
 public:
  struct Excess {
    double value_v = 0;
    double variance = 0;  ///< V^2
  };

  /// @param file   friction of the rig file
  /// @param share  largest deviation of a level from that of the rig file, as a share
  BreakAway(const DriveFriction& file, double share) noexcept;

  /// Call at each tick within the zero band. @param speed  magnitude, m/s or rad/s
  void rest(double friction_v, double speed) noexcept;
  /// True after enough ticks within the zero band for a break-away.
  [[nodiscard]] bool rested() const noexcept;
  void leave_rest() noexcept { rest_ticks_ = 0; }
  /// Call when the axis has left the zero band.
  /// @param direction  0: positive, 1: negative
  /// @param scatter_v  standard deviation of the friction of a block
  /// @return false if these ticks show no break-away level
  bool learn(std::size_t direction, double coulomb_v, double scatter_v) noexcept;

  [[nodiscard]] const Excess& excess(std::size_t direction) const noexcept { return excess_[direction]; }

 private:
  static constexpr int kHistory = 12;
  double zero_band_, share_;
  std::array<double, 2> file_static_v_;
  std::array<Excess, 2> excess_;
  int rest_ticks_ = 0;
  std::array<double, kHistory> resting_v_{};  ///< friction of the last ticks within the zero band
  std::array<bool, kHistory> creeping_{};     ///< true: the speed was within kCreepBands zero bands
};

}  // namespace crane::control::adaptation
