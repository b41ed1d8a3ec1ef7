#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "root_count.hpp"

namespace crane::analysis {
namespace {

/// Change of arg f along the straight line from a to b; nothing when the line passes a root. In each step
/// |f(z + h) - f(z)| <= |f'| h + sup |f''| h^2 / 2 < |f(z)|, so that the step contains no root and turns arg
/// f by less than a quarter turn.
std::optional<double> turn_along(const QuasiPolynomial& f, Complex a, Complex b) {
  const double length = std::abs(b - a);
  const Complex direction = (b - a) / length;
  double done = 0, turned = 0, step = length / 8;
  Complex z = a;
  ValueAndSlope here = evaluate(f, z);
  while (done < length) {
    step = std::min(step, length - done);
    const double size = std::abs(here.value), slope = std::abs(here.slope);
    while (slope * step + curvature_bound(f, z, step) * step * step / 2 >= 0.95 * size) {
      step /= 2;
      if (!(step > 1e-9 * (1 + std::abs(z)))) return std::nullopt;
    }
    done += step;
    z = done < length ? a + done * direction : b;
    const ValueAndSlope there = evaluate(f, z);
    turned += std::arg(there.value / here.value);
    here = there;
    step *= 2;
  }
  return turned;
}

}  // namespace

std::optional<int> roots_inside(const QuasiPolynomial& f, const Box& box) {
  const std::array<Complex, 5> corners{Complex{box.left, box.bottom}, Complex{box.right, box.bottom},
                                       Complex{box.right, box.top}, Complex{box.left, box.top},
                                       Complex{box.left, box.bottom}};
  double turned = 0;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const auto turn = turn_along(f, corners[i], corners[i + 1]);
    if (!turn) return std::nullopt;
    turned += *turn;
  }
  return static_cast<int>(std::lround(turned / (2 * std::numbers::pi)));
}

int count_roots(const QuasiPolynomial& f, const Box& box) {
  if (const auto count = roots_inside(f, box)) return *count;
  throw std::domain_error("a root is on the edge of the box");
}

}  // namespace crane::analysis
