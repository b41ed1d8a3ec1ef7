#include "filter/kalman_filter.hpp"

#include <stdexcept>

#include "filter/filter_of_size.hpp"

namespace crane::innovations {

double student_log_density(double e, double variance) {
  const double nu = rule::kStudent.value;
  static const double constant =
      std::lgamma(0.5 * (nu + 1)) - std::lgamma(0.5 * nu) - 0.5 * std::log(std::numbers::pi * nu);
  return constant - 0.5 * std::log(variance) - 0.5 * (nu + 1) * std::log1p(e * e / (nu * variance));
}

double sensor_variance(const Values& values, const Scales& scales, const Run& run, std::size_t channel) {
  const double noise = std::exp(values[of_noise(channel, kLogSensor)]), floor = scales.floor[channel];
  return noise * noise + floor * floor + run.resolution[channel] * run.resolution[channel] / 12;
}

Innovations filter(const CraneModel& model, const Nominal& nominal, const Scales& scales, const Run& run,
                   const Values& values, const FilterRequest& request) {
  const auto with = [&]<int N>() {
    return FilterOfSize<N>{model, nominal, scales, run, values, request}.finished();
  };
  switch (model.layout.size) {
    case 3:
      return with.operator()<3>();
    case 5:
      return with.operator()<5>();
    case 6:
      return with.operator()<6>();
    case 8:
      return with.operator()<8>();
    default:
      throw std::logic_error("no filter for a state of " + std::to_string(model.layout.size) + " numbers");
  }
}

}  // namespace crane::innovations
