#pragma once
/// The swing angles that a sensor term changes: "radial" or "tangential"; both when the axis is empty.
#include <string_view>

#include "crane/plant/term.hpp"

namespace crane::plant {

struct SwingAxes {
  explicit SwingAxes(std::string_view axis) : radial(axis != "tangential"), tangential(axis != "radial") {}
  bool radial, tangential;
};

/// Calls change(angle, index) with index 0 for the radial and 1 for the tangential angle.
template <class Change>
void for_each_swing(const SwingAxes& axes, Measurement& measured, Change change) {
  if (axes.radial) change(measured.radial_rad, std::size_t{0});
  if (axes.tangential) change(measured.tangential_rad, std::size_t{1});
}

}  // namespace crane::plant
