#pragma once
/// What a drive gets of its command: (1 + gain) dead_zone(u) + offset, late and through two poles.
#include <algorithm>
#include <cmath>

#include "filter/kalman_filter.hpp"

namespace crane::innovations {

class Command {
 public:
  Command(const Series& rows, const Values& values, std::size_t drive, Between between)
      : rows_(rows), values_(values), drive_(drive), between_(between) {
    if (rows.empty()) return;
    raw_ = rows.value[0];
    output_ = first_ = second_ = shaped(raw_);
  }

  [[nodiscard]] double next_s() const {
    return next_ < rows_.size() ? rows_.time_s[next_] + at(kDelay) : 1e300;
  }
  /// Passes the next row. @return |change| times the time since the last row [V s]
  double pass() {
    const std::size_t k = next_++;
    const double area = k == 0 ? 0
                               : std::abs(rows_.value[k] - rows_.value[k - 1]) *
                                     std::min(rows_.time_s[k] - rows_.time_s[k - 1], 0.1);
    raw_ = rows_.value[k];
    output_ = shaped(raw_);
    return area;
  }
  /// Mean volts over [from, from + h]; moves the poles on.
  double mean(double from, double h) {
    if (rows_.empty()) return 0;
    if (between_ == Between::straight && next_ > 0 && next_ < rows_.size()) {
      const double begin = rows_.time_s[next_ - 1], width = rows_.time_s[next_] - begin;
      const double share = std::clamp((from + 0.5 * h - at(kDelay) - begin) / width, 0.0, 1.0);
      output_ = shaped(raw_ + share * (rows_.value[next_] - raw_));
    }
    return lag(h);
  }
  [[nodiscard]] double now() const { return at(kLag) > 0 || at(kSecondLag) > 0 ? second_ : output_; }
  [[nodiscard]] double raw() const { return raw_; }

 private:
  [[nodiscard]] double at(AxisParameter p) const { return values_[of_axis(drive_, p)]; }
  /// Corners rounded by a tenth of the width: an exact corner stops every ascent.
  [[nodiscard]] double shaped(double u) const {
    const double width = at(kDeadZone);
    double v = u;
    if (width > 0) {
      const double corner = 0.1 * width, over = (std::abs(u) - width) / corner;
      v = std::copysign(corner * (over > 30 ? over : std::log1p(std::exp(over))), u);
    }
    return (1 + at(kGain)) * v + at(kOffset);
  }
  /// tau V1' = V0 - V1, tau2 V' = V1 - V, exact for a constant V0; the mean over h.
  double lag(double h) {
    if (at(kLag) <= 0 && at(kSecondLag) <= 0) return output_;
    const double q1 = std::max(at(kLag), 1e-6);
    double q2 = std::max(at(kSecondLag), 1e-6);
    if (std::abs(q1 - q2) < 1e-3 * q1) q2 *= 1.01;
    const double e1 = std::exp(-h / q1), e2 = std::exp(-h / q2);
    const double c1 = (first_ - output_) * q1 / (q1 - q2), c2 = second_ - output_ - c1;
    const double mean = output_ + (c1 * q1 * (1 - e1) + c2 * q2 * (1 - e2)) / h;
    first_ = output_ + (first_ - output_) * e1;
    second_ = output_ + c1 * e1 + c2 * e2;
    return mean;
  }

  const Series& rows_;
  const Values& values_;
  std::size_t drive_, next_ = 0;
  Between between_;
  double raw_ = 0, output_ = 0, first_ = 0, second_ = 0;
};

}  // namespace crane::innovations
