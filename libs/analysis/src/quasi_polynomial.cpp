#include "crane/analysis/quasi_polynomial.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace crane::analysis {
namespace {

/// sum of |c_i| i (i - 1) ... r^(i - order)
double magnitude(const Polynomial& c, double r, std::size_t order) noexcept {
  double sum = 0;
  for (std::size_t i = c.size(); i-- > order;) {
    double factor = std::abs(c[i]);
    for (std::size_t k = 0; k < order; ++k) factor *= static_cast<double>(i - k);
    sum = sum * r + factor;
  }
  return sum;
}

ValueAndSlope horner(const Polynomial& c, Complex s) noexcept {
  ValueAndSlope result;
  for (std::size_t i = c.size(); i-- > 0;) {
    result.slope = result.slope * s + result.value;
    result.value = result.value * s + c[i];
  }
  return result;
}

}  // namespace

Polynomial product(const Polynomial& a, const Polynomial& b) {
  if (a.empty() || b.empty()) return {};
  Polynomial result(a.size() + b.size() - 1, 0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  return result;
}

Polynomial sum(const Polynomial& a, const Polynomial& b) {
  Polynomial result(std::max(a.size(), b.size()), 0);
  for (std::size_t i = 0; i < a.size(); ++i) result[i] += a[i];
  for (std::size_t i = 0; i < b.size(); ++i) result[i] += b[i];
  while (!result.empty() && result.back() == 0) result.pop_back();
  return result;
}

Complex value(const Polynomial& p, Complex s) noexcept { return horner(p, s).value; }

std::vector<Complex> roots_of(const Polynomial& p) {
  if (p.size() < 2) throw std::invalid_argument("a constant has no roots");
  const auto degree = static_cast<Eigen::Index>(p.size() - 1);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  for (Eigen::Index i = 0; i + 1 < degree; ++i) companion(i, i + 1) = 1;
  for (Eigen::Index i = 0; i < degree; ++i)
    companion(degree - 1, i) = -p[static_cast<std::size_t>(i)] / p.back();
  const Eigen::VectorXcd roots = companion.eigenvalues();
  return {roots.data(), roots.data() + roots.size()};
}

const char* QuasiPolynomial::problem() const noexcept {
  if (p.size() < 2 || p.back() == 0) return "p: must have a degree of at least 1";
  if (q.size() > p.size()) return "q: must not have a higher degree than p";
  const auto finite = [](double c) { return std::isfinite(c); };
  if (!std::all_of(p.begin(), p.end(), finite) || !std::all_of(q.begin(), q.end(), finite))
    return "coefficients: must be finite";
  if (!(delay >= 0) || !std::isfinite(delay)) return "delay: must be at least 0 and finite";
  return "";
}

ValueAndSlope evaluate(const QuasiPolynomial& f, Complex s) noexcept {
  const auto p = horner(f.p, s), q = horner(f.q, s);
  const Complex late = std::exp(-f.delay * s);
  return {p.value + q.value * late, p.slope + (q.slope - f.delay * q.value) * late};
}

double curvature_bound(const QuasiPolynomial& f, Complex s, double radius) noexcept {
  const double r = std::abs(s) + radius;
  const double late = std::exp(-f.delay * (s.real() - radius));
  return magnitude(f.p, r, 2) + late * (magnitude(f.q, r, 2) + 2 * f.delay * magnitude(f.q, r, 1) +
                                        f.delay * f.delay * magnitude(f.q, r, 0));
}

double root_bound(const QuasiPolynomial& f, double abscissa) {
  const double late = std::exp(-f.delay * abscissa);
  const double leading = std::abs(f.p.back()) - (f.q.size() == f.p.size() ? late * std::abs(f.q.back()) : 0);
  if (!(leading > 0))
    throw std::invalid_argument(
        "the equation is neutral and has infinitely many roots right of the abscissa");
  // 2 |p_n| r^n - (sum of all terms) has one positive root, because its coefficients change sign once.
  const auto outside = [&](double r) {
    const double all = magnitude(f.p, r, 0) + late * magnitude(f.q, r, 0);
    const double top = std::pow(r, static_cast<double>(f.p.size() - 1));
    const double leading_terms =
        std::abs(f.p.back()) + (f.q.size() == f.p.size() ? late * std::abs(f.q.back()) : 0);
    return leading * top > all - leading_terms * top;
  };
  double radius = 1;
  while (!outside(radius)) radius *= 1.25;
  return radius;
}

}  // namespace crane::analysis
