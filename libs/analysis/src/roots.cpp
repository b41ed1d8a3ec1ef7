#include "crane/analysis/roots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "root_count.hpp"

namespace crane::analysis {
namespace {

constexpr int kMostIterations = 40;
constexpr int kMostTogether = 6;     // a box with more roots is divided
constexpr double kSmallest = 1e-4;   // a box with a smaller half diagonal / (1 + |s|) is not divided
constexpr double kDifferent = 1e-7;  // roots with a smaller distance / (1 + |s|) count as equal
// Relative position of a cut. The symmetry of f puts roots in the middle of a box.
constexpr double kAsymmetry = 0.4871;

double half_diagonal(const Box& box) { return std::hypot(box.right - box.left, box.top - box.bottom) / 2; }
Complex centre(const Box& box) { return {(box.left + box.right) / 2, (box.bottom + box.top) / 2}; }
bool inside(const Box& box, Complex s) {
  return s.real() >= box.left && s.real() <= box.right && s.imag() >= box.bottom && s.imag() <= box.top;
}

/// Newton's method for f / prod (s - found), which does not converge to known roots (Maehly).
Complex newton(const QuasiPolynomial& f, Complex s, const std::vector<Complex>& found) {
  for (int k = 0; k < kMostIterations; ++k) {
    const auto [value, slope] = evaluate(f, s);
    if (value == 0.0) break;
    Complex rate = slope / value;
    for (const Complex& root : found) rate -= 1.0 / (s - root);
    const Complex change = 1.0 / rate;
    s -= change;
    if (!(std::abs(change) > 1e-14 * (1 + std::abs(s)))) break;
  }
  return s;
}

bool is_new(Complex s, const std::vector<Complex>& found) {
  return std::none_of(found.begin(), found.end(), [&](const Complex& root) {
    return std::abs(root - s) < kDifferent * (1 + std::abs(s));
  });
}

/// True when |f(s)| is rounding error: the next Newton step is below the resolution of s.
bool is_root(const QuasiPolynomial& f, Complex s) {
  const auto [value, slope] = evaluate(f, s);
  return std::abs(value) <= 1e-9 * (1 + std::abs(s)) * std::abs(slope);
}

/// Up to `count` different roots in the box; fewer when Newton's method does not find them.
std::vector<Complex> different_roots(const QuasiPolynomial& f, const Box& box, int count) {
  const Complex middle = centre(box);
  const double w = (box.right - box.left) / 4, h = (box.top - box.bottom) / 4;
  const std::array<Complex, 5> starts{middle, middle + Complex{w, h}, middle + Complex{-w, h},
                                      middle + Complex{w, -h}, middle + Complex{-w, -h}};
  std::vector<Complex> found;
  for (const Complex& start : starts) {
    while (static_cast<int>(found.size()) < count) {
      const Complex s = newton(f, newton(f, start, found), {});
      if (!inside(box, s) || !is_root(f, s) || !is_new(s, found)) break;
      found.push_back(s);
    }
  }
  return found;
}

/// Roots of a box that is too small to be divided: one multiple root, by Newton's method with its
/// multiplicity.
Complex multiple_root(const QuasiPolynomial& f, const Box& box, int count) {
  Complex s = centre(box);
  for (int k = 0; k < kMostIterations; ++k) {
    const auto [value, slope] = evaluate(f, s);
    const Complex change = static_cast<double>(count) * value / slope;
    if (!(std::abs(change) < half_diagonal(box)) || !inside(box, s - change)) break;
    s -= change;
  }
  return s;
}

/// Divides the box across its longer side, at a position without a root.
std::pair<std::pair<Box, int>, std::pair<Box, int>> cut(const QuasiPolynomial& f, const Box& box, int count) {
  const bool across = box.right - box.left > box.top - box.bottom;
  for (double share = kAsymmetry; share > 0.1; share *= 0.93) {
    Box one = box, other = box;
    if (across)
      one.right = other.left = box.left + share * (box.right - box.left);
    else
      one.top = other.bottom = box.bottom + share * (box.top - box.bottom);
    if (const auto first = roots_inside(f, one)) return {{one, *first}, {other, count - *first}};
  }
  throw std::domain_error("the box cannot be divided: every cut passes a root");
}

void collect(const QuasiPolynomial& f, const Box& box, int count, std::vector<Complex>& roots) {
  if (count == 0) return;
  if (count <= kMostTogether) {
    const auto found = different_roots(f, box, count);
    if (static_cast<int>(found.size()) == count) {
      roots.insert(roots.end(), found.begin(), found.end());
      return;
    }
  }
  if (half_diagonal(box) < kSmallest * (1 + std::abs(centre(box)))) {
    roots.insert(roots.end(), static_cast<std::size_t>(count), multiple_root(f, box, count));
    return;
  }
  const auto [one, other] = cut(f, box, count);
  collect(f, one.first, one.second, roots);
  collect(f, other.first, other.second, roots);
}

/// Roots in the upper half plane within the region, ordered by decreasing Re s.
std::vector<Complex> upper_half(const std::vector<Complex>& roots, double left, double right, double top) {
  std::vector<Complex> upper;
  for (Complex s : roots) {
    if (std::abs(s.imag()) < 1e-9 * (1 + std::abs(s))) s.imag(0);
    if (s.imag() >= 0 && s.imag() <= top && s.real() >= left && s.real() <= right) upper.push_back(s);
  }
  std::sort(upper.begin(), upper.end(), [](const Complex& a, const Complex& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() < b.imag();
  });
  return upper;
}

}  // namespace

std::vector<Complex> roots_in(const QuasiPolynomial& f, double left, double right, double top) {
  if (*f.problem() != '\0') throw std::invalid_argument(f.problem());
  if (!(left < right) || !(top > 0)) throw std::invalid_argument("the region is empty");
  // The box is larger than the region and includes the real axis. It is enlarged further when a root is on
  // its edge.
  double margin = 1e-3 * (1 + std::min(right - left, top));
  for (int attempt = 0; attempt < 20; ++attempt, margin *= 1.7) {
    const Box box{left - margin, right + margin, -2.3 * margin, top + margin};
    const auto count = roots_inside(f, box);
    if (!count) continue;
    std::vector<Complex> roots;
    collect(f, box, *count, roots);
    return upper_half(roots, left, right, top);
  }
  throw std::domain_error("every tried box has a root on its edge");
}

std::vector<Complex> roots_right_of(const QuasiPolynomial& f, double abscissa) {
  if (*f.problem() != '\0') throw std::invalid_argument(f.problem());
  const double bound = root_bound(f, abscissa);
  if (bound <= abscissa) return {};
  return roots_in(f, std::max(abscissa, -bound), bound, bound);
}

}  // namespace crane::analysis
