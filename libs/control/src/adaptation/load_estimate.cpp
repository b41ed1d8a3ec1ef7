#include "adaptation/load_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace crane::control::adaptation {
namespace {

constexpr double kLengthShare = 0.2;       // initial standard deviation of the length / cable length
constexpr double kLengthBound = 0.5;       // largest |length - cable length| / cable length
constexpr double kFirstOffset_rad = 0.02;  // initial standard deviation of the offsets
constexpr double kOffsetWalk_rad = 2e-5;   // random walk of an offset per block
constexpr double kLengthWalk_m = 2e-4;     // random walk of the length per block
// Smallest standard deviation of a block: terms of second order, quantisation of the encoders.
constexpr double kLeastAcceleration_mps2 = 0.05;
constexpr double kScatterKept = 0.95;  // weight of the earlier blocks in the variance of a block
// Largest speed of slew axis (radial plane) and trolley (tangential plane): their terms of second order are
// omitted.
constexpr double kMostRate_radps = 0.5, kMostSpeed_mps = 0.2;
// Smallest curvature of the swing that corrects the length / standard deviation of the curvature. Noise of
// the curvature would shorten the pendulum (errors in variables).
constexpr double kLeastCurvature = 5;
constexpr double kReadingMemory = 200;   // time constant of the variance of a reading, ticks
constexpr double kImplausibleError = 4;  // largest error, in standard deviations
constexpr int kRefusedBlocks = 10;       // consecutive refused blocks after which the load counts as changed
constexpr double kMostSwing_rad = 0.25;  // largest swing: the equations neglect the swing of the other plane

double square_of(double value) noexcept { return value * value; }

}  // namespace

LoadEstimate::LoadEstimate(const Design& design)
    : gravity_mps2_{design.crane.gravity_mps2},
      period_s_{design.period_s},
      measured_m_{design.cable_length_m} {
  covariance_.diagonal() << square_of(kLengthShare * measured_m_), square_of(kFirstOffset_rad),
      square_of(kFirstOffset_rad);
  scatter_.fill(square_of(2 * kLeastAcceleration_mps2));
}

const LoadEstimate::Sample& LoadEstimate::back(int ticks) const noexcept {
  return samples_[static_cast<std::size_t>((newest_ - ticks + kSamples) % kSamples)];
}

void LoadEstimate::step(const Measurement& m) noexcept {
  newest_ = (newest_ + 1) % kSamples;
  samples_[static_cast<std::size_t>(newest_)] = {
      .swing_rad = {m.swing_radial_rad, m.swing_tangential_rad},
      .sine = {std::sin(m.swing_radial_rad), std::sin(m.swing_tangential_rad)},
      .position = {m.position[kTrolley], m.position[kSlew]},
      .trolley_m = m.position[kTrolley],
      .cable_m = m.position[kHoist]};
  measured_m_ = m.position[kHoist];
  if (filled_ >= 2)
    for (std::size_t plane = 0; plane < 2; ++plane) {
      const double kink = back(0).swing_rad[plane] - 2 * back(1).swing_rad[plane] + back(2).swing_rad[plane];
      reading_[plane] += (square_of(kink) / 6 - reading_[plane]) / kReadingMemory;
    }
  filled_ = std::min(filled_ + 1, kSamples);
  due_ = (due_ + 1) % kSpan;
  if (filled_ == kSamples && due_ == 0) evaluate();
}

void LoadEstimate::evaluate() noexcept {
  const Sample &last = back(0), &middle = back(kSpan), &first = back(2 * kSpan);
  const double span_s = kSpan * period_s_;
  if (std::abs(last.cable_m - first.cable_m) > 1e-3 * middle.cable_m) return;
  std::array<double, 2> mean_sine{}, mean_swing{}, largest{}, turning{};
  double centrifugal = 0, coriolis = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double weight = static_cast<double>(kSpan - std::abs(i - kSpan)) / (kSpan * kSpan);
    for (std::size_t plane = 0; plane < 2; ++plane) {
      mean_sine[plane] += weight * back(i).sine[plane];
      mean_swing[plane] += weight * back(i).swing_rad[plane];
      largest[plane] = std::max(largest[plane], std::abs(back(i).swing_rad[plane]));
    }
    if (weight == 0) continue;
    const auto rate = [&](std::size_t axis) {
      return (back(i - 1).position[axis] - back(i + 1).position[axis]) / (2 * period_s_);
    };
    centrifugal += weight * back(i).trolley_m * rate(1) * rate(1);
    coriolis += weight * 2 * rate(0) * rate(1);
    const auto swing_rate = [&](std::size_t plane) {
      return (back(i - 1).swing_rad[plane] - back(i + 1).swing_rad[plane]) / (2 * period_s_);
    };
    turning[0] += weight * rate(1) * (2 * swing_rate(1) - back(i).swing_rad[0] * rate(1));
    turning[1] -= weight * rate(1) * (2 * swing_rate(0) + back(i).swing_rad[1] * rate(1));
  }
  if (std::max(largest[0], largest[1]) > kMostSwing_rad) return;
  const auto second = [&](double a, double b, double c) { return (a - 2 * b + c) / square_of(span_s); };
  const auto moved = [&](std::size_t i) {
    return std::max(std::abs(last.position[i] - middle.position[i]),
                    std::abs(middle.position[i] - first.position[i])) /
           span_s;
  };
  const double slew_radps2 = second(last.position[1], middle.position[1], first.position[1]);
  turning[0] += mean_swing[1] * slew_radps2;
  turning[1] -= mean_swing[0] * slew_radps2;
  const std::array support{second(last.position[0], middle.position[0], first.position[0]) - centrifugal,
                           -middle.trolley_m * slew_radps2 - coriolis};
  const std::array calm{moved(1) < kMostRate_radps, moved(0) < kMostSpeed_mps};
  for (std::size_t plane = 0; plane < 2; ++plane)
    if (calm[plane])
      update(plane,
             second(last.swing_rad[plane], middle.swing_rad[plane], first.swing_rad[plane]) + turning[plane],
             support[plane] - gravity_mps2_ * mean_sine[plane]);
}

void LoadEstimate::update(std::size_t plane, double curvature, double known) noexcept {
  const auto offset = static_cast<Eigen::Index>(1 + plane);
  covariance_(0, 0) += square_of(kLengthWalk_m);
  covariance_(offset, offset) += square_of(kOffsetWalk_rad);
  Eigen::Vector3d h = Eigen::Vector3d::Zero();
  const double noise = 6 * reading_[plane] / square_of(square_of(kSpan * period_s_));
  if (square_of(curvature) > square_of(kLeastCurvature) * noise) h[0] = curvature;
  h[offset] = -gravity_mps2_;
  const Eigen::Vector3d seen = covariance_ * h;
  const double explained = h.dot(seen), error = known - measured_m_ * curvature - h.dot(estimate_);
  double& scatter = scatter_[plane];
  const bool plausible = square_of(error) <= square_of(kImplausibleError) * (explained + scatter);
  refused_[plane] = plausible ? 0 : refused_[plane] + 1;
  if (!plausible && refused_[plane] < kRefusedBlocks) return;  // the load was pushed
  scatter =
      std::max(square_of(kLeastAcceleration_mps2),
               kScatterKept * scatter + (1 - kScatterKept) * std::max(0.0, square_of(error) - explained));
  const Eigen::Vector3d gain = seen / (explained + scatter);
  estimate_ += gain * error;
  covariance_ -= gain * seen.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  estimate_[0] = std::clamp(estimate_[0], -kLengthBound * measured_m_, kLengthBound * measured_m_);
}

Estimated LoadEstimate::length_m() const noexcept {
  return {.value = measured_m_ + estimate_[0], .std_dev = std::sqrt(std::max(0.0, covariance_(0, 0)))};
}

Estimated LoadEstimate::offset_rad(std::size_t plane) const noexcept {
  const auto i = static_cast<Eigen::Index>(1 + plane);
  return {.value = estimate_[i], .std_dev = std::sqrt(std::max(0.0, covariance_(i, i)))};
}

}  // namespace crane::control::adaptation
