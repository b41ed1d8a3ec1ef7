#pragma once
/// Coefficients of the one-step formulas of the fast method.
/// Sources: J. R. Dormand, P. J. Prince, J. Comp. Appl. Math. 6 (1980) 19; J. Rang, L. Angermann, BIT
/// Numerical Mathematics 45 (2005) 761 (ROS34PW2); E. Hairer, G. Wanner, Solving Ordinary Differential
/// Equations II, 2nd ed., Springer 1996, section IV.7.
#include <array>
#include <cstddef>

namespace crane::simulator {

/// Row vector and lower triangular matrix of a formula of N stages.
template <std::size_t N>
using Weights = std::array<double, N>;
template <std::size_t N>
using Table = std::array<Weights<N>, N>;

template <std::size_t N>
constexpr Table<N> inverse_of(const Table<N>& lower) {
  Table<N> inverse{};
  for (std::size_t column = 0; column < N; ++column)
    for (std::size_t i = column; i < N; ++i) {
      double sum = i == column ? 1 : 0;
      for (std::size_t k = column; k < i; ++k) sum -= lower[i][k] * inverse[k][column];
      inverse[i][column] = sum / lower[i][i];
    }
  return inverse;
}
template <std::size_t N>
constexpr Weights<N> product(const Weights<N>& row, const Table<N>& matrix) {
  Weights<N> result{};
  for (std::size_t j = 0; j < N; ++j)
    for (std::size_t k = 0; k < N; ++k) result[j] += row[k] * matrix[k][j];
  return result;
}

/// ROS34PW2 for y' = f(y) and a matrix J, in the form without products by J:
///   (I / (h gamma) - J) u_i = f(y + sum_j a_ij u_j) + sum_j c_ij u_j / h,  y_1 = y + sum_j a_4j u_j + u_4,
///   a = alpha Gamma^-1,  c = I / gamma - Gamma^-1,  error sum_i e_i u_i with e = (b - b*) Gamma^-1.
/// A W-method: the order is 3, and that of the embedded result 2, for every J. J needs only those parts of
/// df/dy that are stiff; with all of df/dy the formula is L-stable.
struct RosenbrockW {
  static constexpr std::size_t kStages = 4;
  static constexpr double kGamma = 0.435866521508459;
  static constexpr Table<kStages> kAlpha{
      {{}, {0.87173304301691801}, {0.84457060015369423, -0.11299064236484185}, {0, 0, 1}}};
  static constexpr Table<kStages> kGammas{
      {{kGamma},
       {-0.87173304301691801, kGamma},
       {-0.90338057013044082, 0.054180672388095326, kGamma},
       {0.24212380706095346, -1.2232505839045147, 0.54526025533510214, kGamma}}};
  static constexpr Weights<kStages> kB{0.24212380706095346, -1.2232505839045147, 1.5452602553351020, kGamma};
  static constexpr Weights<kStages> kEmbeddedB{0.37810903145819369, -0.096042292212423178, 0.5,
                                               0.2179332607542295};

  static constexpr Table<kStages> kInverse = inverse_of(kGammas);
  static constexpr Table<kStages> kA{product(kAlpha[0], kInverse), product(kAlpha[1], kInverse),
                                     product(kAlpha[2], kInverse), product(kAlpha[3], kInverse)};
  /// c_ij for j < i; the diagonal is not used.
  static constexpr double c(std::size_t i, std::size_t j) { return -kInverse[i][j]; }
  static constexpr Weights<kStages> kError = product(
      {kB[0] - kEmbeddedB[0], kB[1] - kEmbeddedB[1], kB[2] - kEmbeddedB[2], kB[3] - kEmbeddedB[3]}, kInverse);
};

/// Dormand and Prince for y' = f(y): y_1 = y + h sum_j a_7j k_j; kError gives the difference to order 4.
/// k_7 = f(y_1).
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
