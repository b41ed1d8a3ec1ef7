#pragma once
/// Does the compensated axis behave like the linear one? x'' = K_m V (3.4), as in figures 4.7 and 4.9.
#include <span>
#include <vector>

namespace crane::identification {

/// The axis without friction in a position loop V = stiffness (r - x) - damping v, sampled and held, acting
/// one tick late; v is measured as on the rig, by a differentiator behind a low-pass (section 4.3).
struct LinearLoop {
  double gain = 0;           ///< K_m, m/s^2 or rad/s^2 per V
  double stiffness_vpu = 0;  ///< V per m or rad
  double damping_vspu = 0;   ///< V per m/s or rad/s
  double period_s = 0.01;
  double cutoff_ratio = 0;  ///< of the low-pass, of second order; 0: none
};

/// Positions at the times of `reference`, from rest at `start`; exact for the held voltage.
[[nodiscard]] std::vector<double> linear_response(const LinearLoop& loop, std::span<const double> reference,
                                                  double start);

struct Deviation {
  double rms = 0, peak = 0;  ///< m or rad
};
/// @pre both of the same length
[[nodiscard]] Deviation deviation(std::span<const double> measured, std::span<const double> model);

}  // namespace crane::identification
