#include "cli/recorded_box.hpp"

#include <algorithm>
#include <cmath>

namespace crane::cli {

void RecordedBox::add(const msg::State& state) {
  const double cable_m = cable_m_ > 0 ? cable_m_ : state.cable_length_m;
  const double theta = state.swing_tangential_rad, phi = state.swing_radial_rad, slew = state.slew_angle_rad;
  const double along = state.trolley_position_m - cable_m * std::cos(theta) * std::sin(phi);
  const double across = cable_m * std::sin(theta);
  const std::array<double, 3> hook{along * std::cos(slew) - across * std::sin(slew),
                                   along * std::sin(slew) + across * std::cos(slew),
                                   suspension_height_m_ - cable_m * std::cos(theta) * std::cos(phi)};
  if (!std::ranges::all_of(hook, [](double value) { return std::isfinite(value); }) ||
      !std::ranges::all_of(state.position_known, [](bool known) { return known; })) {
    ++skipped_;
    return;
  }
  if (samples_++ == 0) low_ = high_ = hook;
  for (std::size_t i = 0; i < hook.size(); ++i) {
    low_[i] = std::min(low_[i], hook[i]);
    high_[i] = std::max(high_[i], hook[i]);
  }
}

control::Zone RecordedBox::zone(const std::string& name) const {
  return {.name = name,
          .shape = control::ZoneShape::box,
          .position_x_m = (low_[0] + high_[0]) / 2,
          .position_y_m = (low_[1] + high_[1]) / 2,
          .size_x_m = high_[0] - low_[0],
          .size_y_m = high_[1] - low_[1],
          .bottom_m = low_[2],
          .top_m = high_[2]};
}

}  // namespace crane::cli
