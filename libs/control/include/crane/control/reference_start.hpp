#pragma once
/// Measured position of each axis when its reference position last changed; for a step reference, the start
/// of the move. The trajectory planner publishes it, so that all laws see the same value.
#include <array>
#include <limits>

#include "crane/control/law.hpp"

namespace crane::control {

class ReferenceStart {
 public:
  ReferenceStart() noexcept { position_.fill(std::numeric_limits<double>::quiet_NaN()); }

  /// Sets `start` of each axis: its measured position when its reference position last changed.
  void set_starts(const Measurement& measured, Reference& reference) noexcept {
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (reference[i].position != position_[i]) start_[i] = measured.position[i];
      position_[i] = reference[i].position;
      reference[i].start = start_[i];
    }
  }

 private:
  std::array<double, kAxes> position_{}, start_{};
};

}  // namespace crane::control
