#pragma once
/// Characteristic functions of loops with one delay: f(s) = p(s) + q(s) exp(-delay s), real coefficients.
/// Pure functions; equation numbers of H. M. Omar, Control of Gantry and Tower Cranes, as in
/// docs/equations.md.
#include <complex>
#include <vector>

namespace crane::analysis {

using Complex = std::complex<double>;

/// Coefficients in ascending powers, the last one not 0; empty is the zero polynomial.
using Polynomial = std::vector<double>;

[[nodiscard]] Polynomial product(const Polynomial& a, const Polynomial& b);
[[nodiscard]] Polynomial sum(const Polynomial& a, const Polynomial& b);
[[nodiscard]] Complex value(const Polynomial& p, Complex s) noexcept;

/// Every root, by the eigenvalues of the companion matrix. @throws std::invalid_argument for a constant
[[nodiscard]] std::vector<Complex> roots_of(const Polynomial& p);

struct QuasiPolynomial {
  Polynomial p;
  Polynomial q;      ///< degree at most that of p: retarded or neutral, never advanced
  double delay = 0;  ///< >= 0

  /// "name = value: rule" of the first thing that is wrong, empty when usable.
  [[nodiscard]] const char* problem() const noexcept;
};

struct ValueAndSlope {
  Complex value, slope;
};
[[nodiscard]] ValueAndSlope evaluate(const QuasiPolynomial& f, Complex s) noexcept;

/// Bound of |f''| in the disc of `radius` around s.
[[nodiscard]] double curvature_bound(const QuasiPolynomial& f, Complex s, double radius) noexcept;

/// Every root with Re s >= abscissa has |s| <= this: |p_n| R^n = sum |p_i| R^i + exp(-delay abscissa) sum
/// |q_i| R^i.
/// @throws std::invalid_argument when there is no such bound: f is neutral and its chain of roots passes the
/// abscissa
[[nodiscard]] double root_bound(const QuasiPolynomial& f, double abscissa);

}  // namespace crane::analysis
