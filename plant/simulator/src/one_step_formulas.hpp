#pragma once
/// Coefficients of the one-step formulas of the fast method.
/// Sources: J. R. Dormand, P. J. Prince, J. Comp. Appl. Math. 6 (1980) 19; E. Hairer, G. Wanner, Solving
/// Ordinary Differential Equations II, 2nd ed., Springer 1996, section IV.7.
#include <array>
#include <cstddef>

namespace crane::simulator {

/// RODAS for y' = f(y) with Jacobian J, in the form without products by J:
///   (I / (h gamma) - J) u_i = f(y + sum_j a_ij u_j) + sum_j c_ij u_j / h,  y_1 = y + sum_i m_i u_i
/// The last stage is the difference to the embedded formula of order 3.
struct Rodas {
  static constexpr std::size_t kStages = 6;
  static constexpr double kGamma = 0.25;
  static constexpr std::array<std::array<double, 5>, kStages> kA{
      {{},
       {1.544},
       {0.9466785280815826, 0.2557011698983284},
       {3.314825187068521, 2.896124015972201, 0.9986419139977817},
       {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
       {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1}}};
  static constexpr std::array<std::array<double, 5>, kStages> kC{
      {{},
       {-5.6688},
       {-2.430093356833875, -0.2063599157091915},
       {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
       {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
       {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054}}};
};

/// Dormand and Prince for y' = f(y): y_1 = y + h sum_j a_7j k_j; kError gives the difference to order 4.
struct DormandPrince {
  static constexpr std::size_t kStages = 7;
  static constexpr std::array<std::array<double, 6>, kStages> kA{
      {{},
       {1.0 / 5},
       {3.0 / 40, 9.0 / 40},
       {44.0 / 45, -56.0 / 15, 32.0 / 9},
       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
       {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}}};
  static constexpr std::array<double, kStages> kError{
      71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
};

}  // namespace crane::simulator
