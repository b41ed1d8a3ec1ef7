#pragma once
/// Characteristic functions of loops with one delay: f(s) = p(s) + q(s) exp(-delay s) with real coefficients.
/// Pure functions.
#include <complex>
#include <vector>

namespace crane::analysis {

using Complex = std::complex<double>;

/// Coefficients in the order of ascending powers; the last one is not 0. An empty vector is the zero
/// polynomial.
using Polynomial = std::vector<double>;

[[nodiscard]] Polynomial product(const Polynomial& a, const Polynomial& b);
[[nodiscard]] Polynomial sum(const Polynomial& a, const Polynomial& b);
[[nodiscard]] Complex value(const Polynomial& p, Complex s) noexcept;

/// All roots: eigenvalues of the companion matrix. @throws std::invalid_argument for a constant
[[nodiscard]] std::vector<Complex> roots_of(const Polynomial& p);

struct QuasiPolynomial {
  Polynomial p;
  Polynomial q;      ///< degree at most that of p (retarded or neutral equation)
  double delay = 0;  ///< >= 0

  /// @return the first problem as "name: rule"; empty when there is none
  [[nodiscard]] const char* problem() const noexcept;
};

struct ValueAndSlope {
  Complex value, slope;
};
[[nodiscard]] ValueAndSlope evaluate(const QuasiPolynomial& f, Complex s) noexcept;

/// Upper bound of |f''| in the disc of `radius` around s.
[[nodiscard]] double curvature_bound(const QuasiPolynomial& f, Complex s, double radius) noexcept;

/// @return R such that every root with Re s >= abscissa has |s| <= R. R is 1, or less than 1.25 times
///   the positive root of (|p_n| - E |q_n|) r^n = sum (|p_i| + E |q_i|) r^i, i < n, E = exp(-delay abscissa)
/// @throws std::invalid_argument when no bound exists: f is neutral with a chain of roots right of the
///   abscissa
[[nodiscard]] double root_bound(const QuasiPolynomial& f, double abscissa);

}  // namespace crane::analysis
