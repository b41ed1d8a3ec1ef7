#pragma once
/// Random numbers that are the same with every compiler: splitmix64 (Steele, Lea, Flood 2014), Box-Muller.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace truth {

class Random {
 public:
  /// A separate stream for every purpose, so that an additional effect does not change the disturbance.
  Random(std::uint64_t seed, std::string_view purpose)
      : state_(seed * 0x9e3779b97f4a7c15ULL + 0x632be59bd9b4e019ULL) {
    for (const char c : purpose) {
      state_ ^= static_cast<unsigned char>(c);
      next();
    }
  }

  /// @return a number in [0, 1)
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double sign() { return uniform() < 0.5 ? -1 : 1; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return z;
  }
  std::uint64_t state_;
};

/// First-order coloured noise of given rms, correlation time and sampling interval.
class Coloured {
 public:
  Coloured(Random random, double rms, double correlation_s, double interval_s)
      : random_(random),
        rms_(rms),
        keep_(std::exp(-interval_s / correlation_s)),
        value_(rms * random_.normal()) {}
  double value() const { return value_; }
  void silence() { rms_ = value_ = 0; }
  double step() {
    value_ = keep_ * value_ + rms_ * std::sqrt(1 - keep_ * keep_) * random_.normal();
    return value_;
  }

 private:
  Random random_;
  double rms_, keep_, value_;
};

}  // namespace truth
