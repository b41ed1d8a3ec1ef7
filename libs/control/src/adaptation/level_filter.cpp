#include "adaptation/level_filter.hpp"

#include <algorithm>
#include <cmath>

namespace crane::control::adaptation {
namespace {

constexpr double kLeastScatter_v = 0.02;    // smallest scatter of a block: effects outside the force balance
constexpr double kFirstScatter_v = 0.05;    // scatter before the first block
constexpr double kScatterMemory = 0.95;     // weight of the earlier blocks in the variance of a block
constexpr double kWalkShare = 0.002;        // random walk of a level per block / level of the rig file
constexpr double kPayloadWalkShare = 0.03;  // random walk of the payload per move / payload of the rig file
constexpr double kPayloadShare = 0.3;       // initial standard deviation of the payload / payload
constexpr double kPayloadBound = 0.9;       // the payload stays within 0.1 and 2.9 times that of the rig file
constexpr double kInertiaShare = 0.05;      // initial standard deviation of r
constexpr double kInertiaBound = 0.3;       // largest |r|
constexpr double kImplausible = 5;          // largest |innovation|, in standard deviations

double squared(double value) noexcept { return value * value; }

}  // namespace

LevelFilter::LevelFilter(const Design& design) {
  const auto& settings = design.adaptation;
  for (std::size_t axis = 0; axis < kAdaptedAxes; ++axis) {
    const DriveFriction& f = design.friction[axis];
    const std::array<double, 4> values{f.coulomb_positive_v, f.viscous_positive_vspm, f.coulomb_negative_v,
                                       f.viscous_negative_vspm};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto state = static_cast<Eigen::Index>(4 * axis + i);
      const double share = i % 2 == 0 ? settings.friction_share : settings.viscous_share;
      nominal_[state] = values[i];
      share_[state] = share;
      prior_[state] = values[i] * share / 2;
    }
  }
  nominal_[kMass] = design.crane.load_mass_kg;
  share_[kMass] = kPayloadBound;
  prior_[kMass] = kPayloadShare * nominal_[kMass];
  for (const int i : {kInertia, kInertia + 1}) prior_[i] = kInertiaShare;
  estimate_ = nominal_;
  covariance_ = prior_.cwiseAbs2().asDiagonal();
  scatter_.fill(squared(kFirstScatter_v));
}

LevelFilter::Vector LevelFilter::regressor(std::size_t axis, std::size_t direction,
                                           const Block& block) noexcept {
  Vector h = Vector::Zero();
  const int first = index(axis, direction);
  h[first] = 1;
  h[first + 1] = block.speed;
  h[kMass] = -block.load_vpkg;
  h[kInertia + static_cast<int>(axis)] = block.inertia_v;
  return h;
}

double LevelFilter::friction_v(std::size_t axis, const Block& block) const noexcept {
  return block.free_v + estimate_[kMass] * block.load_vpkg -
         estimate_[kInertia + static_cast<int>(axis)] * block.inertia_v;
}

LevelFilter::Innovation LevelFilter::innovation(std::size_t axis, std::size_t direction,
                                                const Block& block) const noexcept {
  const Vector h = regressor(axis, direction, block);
  const double variance = h.dot(covariance_ * h) + scatter_[axis];
  const double value_v = block.free_v - h.dot(estimate_);
  return {.value_v = value_v,
          .deviation_v = std::sqrt(variance),
          .plausible = squared(value_v) <= squared(kImplausible) * variance};
}

void LevelFilter::update(std::size_t axis, std::size_t direction, const Block& block) noexcept {
  const int first = index(axis, direction);
  for (const int i : {first, first + 1})
    covariance_(i, i) = std::min(covariance_(i, i) + squared(kWalkShare * nominal_[i]),
                                 std::max(covariance_(i, i), squared(prior_[i])));
  const Vector h = regressor(axis, direction, block);
  const Vector seen = covariance_ * h;
  const double explained = h.dot(seen), error = block.free_v - h.dot(estimate_);
  double& scatter = scatter_[axis];
  scatter =
      std::max(squared(kLeastScatter_v),
               kScatterMemory * scatter + (1 - kScatterMemory) * std::max(0.0, squared(error) - explained));
  const Vector gain = seen / (explained + scatter);
  estimate_ += gain * error;
  covariance_ -= gain * seen.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  for (const int i : {kInertia, kInertia + 1})
    estimate_[i] = std::clamp(estimate_[i], -kInertiaBound, kInertiaBound);
  for (int i = 0; i <= kMass; ++i) {
    const double low = nominal_[i] * (1 - share_[i]);
    const double high = nominal_[i] * (i == kMass ? 2 + share_[i] : 1 + share_[i]);
    estimate_[i] = std::clamp(estimate_[i], low, high);
  }
}

void LevelFilter::forget(std::size_t axis, std::size_t direction) noexcept {
  const int first = index(axis, direction);
  for (const int i : {first, first + 1}) {
    covariance_.row(i).setZero();
    covariance_.col(i).setZero();
    covariance_(i, i) = squared(prior_[i]);
  }
}

void LevelFilter::restart(std::size_t axis, std::size_t direction) noexcept {
  forget(axis, direction);
  const int first = index(axis, direction);
  for (const int i : {first, first + 1}) estimate_[i] = nominal_[i];
}

void LevelFilter::loosen_payload() noexcept {
  covariance_(kMass, kMass) =
      std::min(covariance_(kMass, kMass) + squared(kPayloadWalkShare * nominal_[kMass]),
               std::max(covariance_(kMass, kMass), squared(prior_[kMass])));
}

bool LevelFilter::payload_at_bound() const noexcept {
  const double mass = estimate_[kMass], nominal = nominal_[kMass];
  return nominal > 0 && (mass <= nominal * (1 - share_[kMass]) || mass >= nominal * (2 + share_[kMass]));
}

Estimated LevelFilter::at(int i) const noexcept {
  return {.value = estimate_[i], .std_dev = std::sqrt(std::max(0.0, covariance_(i, i)))};
}

Estimated LevelFilter::moving_v(std::size_t axis, std::size_t direction, double speed) const noexcept {
  const int c = index(axis, direction), b = c + 1;
  const double variance =
      covariance_(c, c) + 2 * speed * covariance_(c, b) + speed * speed * covariance_(b, b);
  return {.value = estimate_[c] + estimate_[b] * speed, .std_dev = std::sqrt(std::max(0.0, variance))};
}

double LevelFilter::noise_v(std::size_t axis) const noexcept {
  return std::sqrt(std::max(0.0, scatter_[axis] - squared(kLeastScatter_v)));
}

double LevelFilter::scatter_v(std::size_t axis) const noexcept { return std::sqrt(scatter_[axis]); }

Estimated LevelFilter::coulomb_v(std::size_t axis, std::size_t direction) const noexcept {
  return at(index(axis, direction));
}

Estimated LevelFilter::viscous_vspm(std::size_t axis, std::size_t direction) const noexcept {
  return at(index(axis, direction) + 1);
}

}  // namespace crane::control::adaptation
