#pragma once
/// Seeded random numbers with one stream for each purpose, so that an additional fault does not change
/// disturbance and noise.
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace mujoco_truth {

class Chance {
 public:
  Chance(std::uint64_t seed, const std::string& purpose) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(std::hash<std::string>{}(purpose)), 77u};
    engine_.seed(sequence);
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// Uniform on a logarithmic scale.
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double normal() { return std::normal_distribution<double>()(engine_); }
  double sign() { return happens(0.5) ? -1 : 1; }
  bool happens(double probability) { return uniform(0, 1) < probability; }
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
  }
  template <class T>
  const T& one_of(const std::vector<T>& all) {
    return all[below(all.size())];
  }

 private:
  std::mt19937_64 engine_;
};

/// First-order coloured noise of unit variance on a grid, interpolated linearly.
class Coloured {
 public:
  Coloured() = default;
  Coloured(Chance& chance, double duration_s, double correlation_s);
  [[nodiscard]] double at(double time_s) const;

 private:
  std::vector<double> values_;
};

}  // namespace mujoco_truth
