#include "crane/analysis/pade.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <stdexcept>

namespace crane::analysis {
namespace {

/// System matrix of the loop with `order` = l all-pass sections for the delay tau. States: w, w', ... of
/// p(d/dt) w = -u_l, then one state x_i per section with c x_i' = u_(i-1) - x_i, u_i = 2 x_i - u_(i-1),
/// c = tau / 2l, u_0 = q(d/dt) w.
Eigen::MatrixXd loop(const QuasiPolynomial& f, Eigen::Index order) {
  const auto degree = static_cast<Eigen::Index>(f.p.size() - 1);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(degree + order, degree + order);
  Eigen::RowVectorXd u = Eigen::RowVectorXd::Zero(degree + order);
  for (std::size_t i = 0; i < f.q.size(); ++i) u(static_cast<Eigen::Index>(i)) = f.q[i];
  const double c = f.delay / (2 * static_cast<double>(order));
  for (Eigen::Index i = degree; i < degree + order; ++i) {
    a.row(i) = u / c;
    a(i, i) -= 1 / c;
    u = -u;
    u(i) += 2;
  }
  for (Eigen::Index i = 0; i + 1 < degree; ++i) a(i, i + 1) = 1;
  a.row(degree - 1) = -u / f.p.back();
  for (Eigen::Index i = 0; i < degree; ++i) a(degree - 1, i) -= f.p[static_cast<std::size_t>(i)] / f.p.back();
  return a;
}

}  // namespace

std::vector<Complex> pade_roots(const QuasiPolynomial& f, int order) {
  if (*f.problem() != '\0') throw std::invalid_argument(f.problem());
  if (f.q.size() >= f.p.size()) throw std::invalid_argument("q: must have a lower degree than p");
  if (order < 1) throw std::invalid_argument("order: must be at least 1");
  const Eigen::VectorXcd all = loop(f, f.delay > 0 && !f.q.empty() ? order : 0).eigenvalues();
  std::vector<Complex> roots;
  std::copy_if(all.begin(), all.end(), std::back_inserter(roots),
               [](const Complex& s) { return s.imag() >= 0; });
  std::sort(roots.begin(), roots.end(),
            [](const Complex& a, const Complex& b) { return a.real() > b.real(); });
  return roots;
}

}  // namespace crane::analysis
