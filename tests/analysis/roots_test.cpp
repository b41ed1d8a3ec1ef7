/// Compares the roots with three independent methods: the companion matrix, a Chebyshev discretisation of the
/// delayed state, and an integral of f'/f around the region.
#include "crane/analysis/roots.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "crane/analysis/anti_swing_loop.hpp"

namespace crane::analysis {
namespace {

using std::numbers::pi;
constexpr unsigned kSeed = 20260101;

/// Largest distance of a root of `few` to the nearest root of `many`.
double farthest(const std::vector<Complex>& few, const std::vector<Complex>& many) {
  double worst = 0;
  for (const Complex& a : few) {
    double nearest = 1e9;
    for (const Complex& b : many) nearest = std::min(nearest, std::abs(a - b));
    worst = std::max(worst, nearest);
  }
  return worst;
}

std::vector<Complex> chosen(const std::vector<Complex>& roots, double left, double top, double right = 1e9) {
  std::vector<Complex> result;
  std::copy_if(roots.begin(), roots.end(), std::back_inserter(result), [&](const Complex& s) {
    return s.real() >= left && s.real() <= right && s.imag() >= -1e-9 && s.imag() <= top;
  });
  return result;
}

/// Eigenvalues of x'(t) = A x(t) + B x(t - tau) with x on Chebyshev nodes over [-tau, 0].
std::vector<Complex> spectral_roots(const QuasiPolynomial& f, int nodes) {
  const auto n = static_cast<Eigen::Index>(f.p.size() - 1);
  const Eigen::Index last = nodes;
  Eigen::MatrixXd d(last + 1, last + 1);  // differentiation over [-1, 1], first node +1
  const auto x = [&](Eigen::Index i) { return std::cos(pi * static_cast<double>(i) / nodes); };
  const auto c = [&](Eigen::Index i) { return (i == 0 || i == last ? 2.0 : 1.0) * (i % 2 == 0 ? 1 : -1); };
  for (Eigen::Index i = 0; i <= last; ++i)
    for (Eigen::Index j = 0; j <= last; ++j) d(i, j) = i == j ? 0 : c(i) / c(j) / (x(i) - x(j));
  for (Eigen::Index i = 0; i <= last; ++i) d(i, i) = -d.row(i).sum();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n * (last + 1), n * (last + 1));
  for (Eigen::Index i = 1; i <= last; ++i)
    for (Eigen::Index j = 0; j <= last; ++j)
      a.block(n * i, n * j, n, n) = Eigen::MatrixXd::Identity(n, n) * d(i, j) * 2 / f.delay;
  for (Eigen::Index i = 0; i + 1 < n; ++i) a(i, i + 1) = 1;
  for (Eigen::Index i = 0; i < n; ++i) a(n - 1, i) = -f.p[static_cast<std::size_t>(i)] / f.p.back();
  for (std::size_t i = 0; i < f.q.size(); ++i)
    a(n - 1, n * last + static_cast<Eigen::Index>(i)) = -f.q[i] / f.p.back();
  const Eigen::VectorXcd roots = a.eigenvalues();
  return {roots.data(), roots.data() + roots.size()};
}

/// 1 / 2 pi i times the integral of f'/f around the box, by the midpoint rule.
double integral_count(const QuasiPolynomial& f, const Box& box, int points) {
  const Complex corners[] = {{box.left, box.bottom},
                             {box.right, box.bottom},
                             {box.right, box.top},
                             {box.left, box.top},
                             {box.left, box.bottom}};
  Complex sum = 0;
  for (int edge = 0; edge < 4; ++edge) {
    const Complex step = (corners[edge + 1] - corners[edge]) / static_cast<double>(points);
    for (int k = 0; k < points; ++k) {
      const auto [value, slope] = evaluate(f, corners[edge] + (k + 0.5) * step);
      sum += slope / value * step;
    }
  }
  return (sum / Complex{0, 2 * pi}).real();
}

TEST(Roots, AreThoseOfTheCompanionMatrixWithoutDelay) {
  std::mt19937 random{kSeed};
  std::uniform_real_distribution<double> coefficient{-3, 3};
  for (int k = 0; k < 200; ++k) {
    Polynomial p(3 + static_cast<std::size_t>(k % 6));
    for (double& c : p) c = coefficient(random);
    const auto expected = chosen(roots_of(p), -50, 50, 50);
    const auto found = roots_in({p, {}, 0}, -50, 50, 50);
    ASSERT_EQ(found.size(), expected.size()) << "seed " << kSeed << ", polynomial " << k;
    EXPECT_LT(farthest(expected, found), 1e-6) << "seed " << kSeed << ", polynomial " << k;
  }
}

TEST(Roots, AreThoseOfAChebyshevDiscretisationOfTheDelayedState) {
  std::mt19937 random{kSeed};
  std::uniform_real_distribution<double> share{0, 1};
  for (int k = 0; k < 12; ++k) {
    const bool first = k % 2 == 0;
    const GainPoint gains{first ? -150 + 200 * share(random) : -1 + 1.3 * share(random),
                          0.05 + 0.5 * share(random)};
    const auto f = characteristic(first ? AntiSwing::delayed_1 : AntiSwing::delayed_2, gains);
    const auto found = roots_right_of(f, -6);
    // 40 nodes resolve exp(tau s) for |tau s| up to about 20.
    const auto spectral = spectral_roots(f, 40);
    EXPECT_LT(farthest(chosen(spectral, -6 + 1e-6, 40), found), 1e-5) << gains.first << " " << gains.second;
    EXPECT_LT(farthest(chosen(found, -6, 40), spectral), 1e-5) << gains.first << " " << gains.second;
  }
}

TEST(Roots, AreAsManyAsTheIntegralOfTheLogarithmicDerivativeStates) {
  std::mt19937 random{kSeed};
  std::uniform_real_distribution<double> share{0, 1};
  int compared = 0;
  for (int k = 0; k < 60; ++k) {
    const auto law = static_cast<AntiSwing>(k % 3);
    const auto& kind = kAntiSwingKinds[static_cast<std::size_t>(k % 3)];
    const GainPoint gains{kind.first.low + (kind.first.high - kind.first.low) * share(random),
                          kind.second.low + (kind.second.high - kind.second.low) * share(random)};
    const auto f = characteristic(law, gains, {}, {k % 2 == 0 ? 0.0 : 60.0});
    const Box box{-14.3, 21.7, 0.21, 61.3};  // above the real axis
    const double integral = integral_count(f, box, 4000);
    if (std::abs(integral - std::round(integral)) > 0.01)
      continue;  // a root is too near the edge for this quadrature rule
    ++compared;
    int found = 0;
    for (const Complex& s : roots_in(f, box.left, box.right, box.top)) found += s.imag() >= box.bottom;
    EXPECT_EQ(found, std::lround(integral)) << kind.name << " " << gains.first << " " << gains.second;
    EXPECT_EQ(count_roots(f, box), std::lround(integral))
        << kind.name << " " << gains.first << " " << gains.second;
  }
  EXPECT_GT(compared, 50) << "seed " << kSeed;
}

TEST(Roots, AreRootsToRoundingAndComeRightMostFirst) {
  const auto f = characteristic(AntiSwing::delayed_2, {-0.33, 0.31});
  const auto roots = roots_right_of(f, -14);
  ASSERT_GT(roots.size(), 20u);  // roots of the chain of the delay, up to |Im s| of some hundreds
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const auto [value, slope] = evaluate(f, roots[i]);
    EXPECT_LT(std::abs(value / slope), 1e-10 * (1 + std::abs(roots[i]))) << roots[i];
    EXPECT_LE(roots[i].real(), roots[i > 0 ? i - 1 : 0].real());
  }
}

TEST(Roots, ThatAreDoubleAreFoundTwice) {
  const Polynomial pair{58, 6, 1};  // -3 +- 7i
  const auto roots = roots_in({product(product(pair, pair), {1, 1}), {}, 0}, -20, 5, 20);
  ASSERT_EQ(roots.size(), 3u);
  EXPECT_NEAR(std::abs(roots[0] - Complex(-1, 0)), 0, 1e-12);
  for (const std::size_t i : {1u, 2u}) EXPECT_NEAR(std::abs(roots[i] - Complex(-3, 7)), 0, 1e-5);
}

TEST(Roots, OnTheEdgeOfABoxAreNotCounted) {
  const QuasiPolynomial f{{4, 0, 1}, {}, 0};  // +-2i
  EXPECT_EQ(count_roots(f, {-1, 1, 1, 3}), 1);
  EXPECT_THROW((void)count_roots(f, {0, 1, 1, 3}), std::domain_error);
  EXPECT_EQ(roots_in(f, -1, 0, 2).size(), 1u);  // the search uses a margin
}

TEST(Roots, RefuseInvalidEquationsAndRegions) {
  const QuasiPolynomial good{{1, 1}, {0.5}, 1};
  EXPECT_THROW((void)roots_in(good, 1, 1, 5), std::invalid_argument);
  EXPECT_THROW((void)roots_in(good, -1, 1, 0), std::invalid_argument);
  EXPECT_THROW((void)roots_in({{1}, {}, 0}, -1, 1, 1), std::invalid_argument);
  EXPECT_THROW((void)roots_in({{1, 1}, {1, 1, 1}, 1}, -1, 1, 1), std::invalid_argument);  // advanced
  EXPECT_THROW((void)roots_in({{1, 1}, {NAN}, 1}, -1, 1, 1), std::invalid_argument);
  EXPECT_THROW((void)roots_in({{1, 1}, {1}, -1}, -1, 1, 1), std::invalid_argument);
  // Neutral equation: the chain of s + 1 + 0.5 s exp(-s) tends to Re s = ln 0.5.
  EXPECT_THROW((void)roots_right_of({{1, 1}, {0, 0.5}, 1}, -1), std::invalid_argument);
  EXPECT_TRUE(roots_right_of({{1, 1}, {0, 0.5}, 1}, -0.1).empty());
}

}  // namespace
}  // namespace crane::analysis
