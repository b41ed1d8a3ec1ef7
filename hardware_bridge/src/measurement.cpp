#include "crane/bridge/measurement.hpp"

#include <algorithm>

#include "crane/bridge/start_counts.hpp"

namespace crane::bridge {

std::int64_t CountUnwrapper::step(std::int32_t raw_counts) noexcept {
  constexpr std::int64_t kRange = 1 << 24;
  std::int64_t change = (raw_counts - counts_) % kRange;  // the counter shows counts_ modulo 2^24
  if (change >= kRange / 2) change -= kRange;
  if (change < -kRange / 2) change += kRange;
  return counts_ += change;
}

Coordinate::Coordinate(const configuration::Encoder& encoder, double period_s, double cutoff_ratio,
                       bool filter_position, std::int64_t start)
    : unwrapper_{start},
      units_per_count_{encoder.counts_per_unit > 0 ? encoder.sign / encoder.counts_per_unit : 0},
      rest_{encoder.rest_angle_rad},
      filter_position_{filter_position},
      low_pass_{control::butterworth_low_pass(cutoff_ratio)},
      differentiator_{control::al_alaoui_second_order(1 / period_s)} {}

void Coordinate::filter(double position) noexcept {
  smooth_ = control::step(low_pass_, low_pass_memory_, position);
  rate_ = control::step(differentiator_, differentiator_memory_, smooth_);
}

void Coordinate::step(std::int32_t raw_counts, const Latched& latched) noexcept {
  counts_ = unwrapper_.step(raw_counts) + shift_;
  position_ = static_cast<double>(counts_) * units_per_count_ - rest_;
  if (!started_) {
    started_ = true;
    low_pass_memory_ = control::settled(low_pass_, position_);
    differentiator_memory_ = control::settled(differentiator_, position_);
    gridded_ = position_;
    rate_ = 0;
  }
  constexpr std::uint64_t kMostFilled = 100;  // ticks; after a longer pause the axis is at rest
  const double target = position_ - rate_ * latched.late_s;
  const auto steps = std::clamp<std::uint64_t>(latched.ticks, 1, kMostFilled);
  for (std::uint64_t i = 1; i < steps; ++i)
    filter(gridded_ + (target - gridded_) * static_cast<double>(i) / static_cast<double>(steps));
  filter(target);
  gridded_ = target;
  if (filter_position_) position_ = smooth_;
}

void Coordinate::shift(std::int64_t change) noexcept {
  shift_ += change;
  started_ = false;  // the next step initialises the filters
}

namespace {

/// The rig file selects the axes whose position is filtered before the differentiation: on the Virginia Tech
/// rig, this filter makes the trolley oscillate (section 4.4.1). The rates of the swing are always filtered.
Coordinate coordinate(const configuration::Rig& rig, std::size_t counter, std::int64_t start) {
  const bool swing = counter >= plant::kAxes;
  const bool filtered = swing || rig.sensing.filter_speed[counter];
  return {rig.encoders[counter], rig.period_s, filtered ? rig.sensing.swing_filter_ratio : 0.0,
          swing && rig.sensing.filter_swing_angle, start};
}

}  // namespace

MeasurementPipeline::MeasurementPipeline(const configuration::Rig& rig)
    : MeasurementPipeline{rig, start_counts(rig)} {}

MeasurementPipeline::MeasurementPipeline(const configuration::Rig& rig,
                                         const std::array<std::int64_t, kCounters>& start)
    : coordinates_{coordinate(rig, 0, start[0]), coordinate(rig, 1, start[1]), coordinate(rig, 2, start[2]),
                   coordinate(rig, 3, start[3]), coordinate(rig, 4, start[4])} {}

control::Measurement MeasurementPipeline::step(const std::array<std::int32_t, kCounters>& raw_counts,
                                               const Latched& latched) noexcept {
  for (std::size_t i = 0; i < kCounters; ++i) coordinates_[i].step(raw_counts[i], latched);
  control::Measurement measured;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    measured.position[i] = coordinates_[i].position();
    measured.speed[i] = coordinates_[i].rate();
  }
  measured.swing_radial_rad = coordinates_[3].position();
  measured.swing_radial_radps = coordinates_[3].rate();
  measured.swing_tangential_rad = coordinates_[4].position();
  measured.swing_tangential_radps = coordinates_[4].rate();
  return measured;
}

}  // namespace crane::bridge
