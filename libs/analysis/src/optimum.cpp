#include <algorithm>
#include <array>
#include <cmath>

#include "crane/analysis/damping.hpp"

namespace crane::analysis {
namespace {

constexpr std::size_t kMostStarts = 4;
constexpr int kMostRestarts = 20, kIdleRestarts = 3;
constexpr double kWorthwhile = 1e-6;  // smallest improvement of the damping ratio for a restart

/// The merit as a function of two coordinates, scaled to [0, 1] over the ranges. Outside the ranges it is
/// smaller than any merit.
class Landscape {
 public:
  Landscape(const LoopDamping& damping, const DampingMap& map, Measure measure)
      : damping_(damping), map_(map), measure_(measure) {}

  [[nodiscard]] GainPoint gains(double u, double v) const {
    return {map_.first.low + u * (map_.first.high - map_.first.low),
            map_.second.low + v * (map_.second.high - map_.second.low)};
  }
  [[nodiscard]] double height(double u, double v) const {
    if (u < 0 || u > 1 || v < 0 || v > 1) return -2;
    return merit(damping_(gains(u, v)), measure_);
  }

 private:
  const LoopDamping& damping_;
  const DampingMap& map_;
  Measure measure_;
};

struct Vertex {
  double u = 0, v = 0, height = 0;
};

/// Simplex method of Nelder and Mead with standard coefficients, from an equilateral simplex.
Vertex climb(const Landscape& landscape, const Vertex& from, double size) {
  const auto at = [&](double u, double v) { return Vertex{u, v, landscape.height(u, v)}; };
  std::array<Vertex, 3> s{from, at(from.u + size, from.v + 0.26795 * size),
                          at(from.u + 0.26795 * size, from.v + size)};
  for (int k = 0; k < 200; ++k) {
    std::sort(s.begin(), s.end(), [](const Vertex& a, const Vertex& b) { return a.height > b.height; });
    if (std::hypot(s[2].u - s[0].u, s[2].v - s[0].v) < 1e-7) break;
    const double mu = (s[0].u + s[1].u) / 2, mv = (s[0].v + s[1].v) / 2;
    const auto along = [&](double t) { return at(mu + t * (s[2].u - mu), mv + t * (s[2].v - mv)); };
    const Vertex reflected = along(-1);
    if (reflected.height > s[0].height) {
      const Vertex expanded = along(-2);
      s[2] = expanded.height > reflected.height ? expanded : reflected;
    } else if (reflected.height > s[1].height) {
      s[2] = reflected;
    } else {
      const Vertex contracted = along(reflected.height > s[2].height ? -0.5 : 0.5);
      if (contracted.height > std::max(s[2].height, reflected.height)) {
        s[2] = contracted;
      } else {
        for (std::size_t i = 1; i < 3; ++i) s[i] = at((s[0].u + s[i].u) / 2, (s[0].v + s[i].v) / 2);
      }
    }
  }
  return *std::max_element(s.begin(), s.end(),
                           [](const Vertex& a, const Vertex& b) { return a.height < b.height; });
}

/// Local maxima of the map, in descending order.
std::vector<Vertex> local_maxima(const DampingMap& map, Measure measure) {
  std::vector<Vertex> found;
  const auto height = [&](int i, int j) { return merit(map.at(i, j), measure); };
  for (int j = 0; j < map.second.points; ++j)
    for (int i = 0; i < map.first.points; ++i) {
      bool highest = true;
      for (int n = std::max(0, j - 1); n <= std::min(map.second.points - 1, j + 1); ++n)
        for (int m = std::max(0, i - 1); m <= std::min(map.first.points - 1, i + 1); ++m)
          highest = highest && height(m, n) <= height(i, j);
      if (highest)
        found.push_back({static_cast<double>(i) / (map.first.points - 1),
                         static_cast<double>(j) / (map.second.points - 1), height(i, j)});
    }
  std::sort(found.begin(), found.end(), [](const Vertex& a, const Vertex& b) { return a.height > b.height; });
  if (found.size() > kMostStarts) found.resize(kMostStarts);
  return found;
}

}  // namespace

Optimum optimum(const LoopDamping& damping, const DampingMap& map, Measure measure) {
  const Landscape landscape{damping, map, measure};
  Vertex best{0, 0, -3};
  for (Vertex top : local_maxima(map, measure)) {
    // The merit has a sharp ridge where two pairs exchange their order. A simplex that has collapsed on the
    // ridge is restarted with another orientation and size.
    double size = 1.0 / map.first.points;
    for (int k = 0, idle = 0; k < kMostRestarts && idle < kIdleRestarts; ++k, size *= -0.7) {
      const Vertex higher = climb(landscape, top, size);
      idle = higher.height > top.height + kWorthwhile ? 0 : idle + 1;
      if (higher.height > top.height) top = higher;
    }
    if (top.height > best.height) best = top;
  }
  const GainPoint gains = landscape.gains(best.u, best.v);
  return {gains, damping(gains)};
}

}  // namespace crane::analysis
