#pragma once
/// Compares an axis with friction compensation with the linear axis x'' = K_m V (3.4), as in figures 4.7 and
/// 4.9. Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
#include <span>
#include <vector>

namespace crane::identification {

/// An axis without friction in the position loop V = stiffness (r - x) - damping v. V is sampled, held, and
/// acts one tick later. v is measured as on the rig: low-pass filter and differentiator (section 4.3).
struct LinearLoop {
  double gain = 0;           ///< K_m, m/s^2 or rad/s^2 per V
  double stiffness_vpu = 0;  ///< V per m or rad
  double damping_vspu = 0;   ///< V per m/s or rad/s
  double period_s = 0.01;
  /// Cut-off / sampling frequency of the second-order low-pass filter; 0: no filter.
  double cutoff_ratio = 0;
};

/// Positions at the times of `reference`, from rest at `start`; exact solution for the held voltage.
[[nodiscard]] std::vector<double> linear_response(const LinearLoop& loop, std::span<const double> reference,
                                                  double start);

struct Deviation {
  double rms = 0, peak = 0;  ///< m or rad
};
/// @pre both have the same length
[[nodiscard]] Deviation deviation(std::span<const double> measured, std::span<const double> model);

}  // namespace crane::identification
