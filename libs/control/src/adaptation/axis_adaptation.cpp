#include "adaptation/axis_adaptation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace crane::control::adaptation {
namespace {

// Chosen values; docs/adaptation.md explains the method. "Level of the file": level of the rig file.
constexpr int kBlock_ticks = 6;    // duration of a block: quantises the friction of the slew axis by 0.01 V
constexpr int kSkipped_ticks = 2;  // start of a motion: the second difference still covers the time at rest
// lowest speed of learning / zero band; above this speed the break-away excess has decayed
constexpr double kLearnBands = 2;
constexpr double kMargin = 1;         // estimate minus level in use, in standard deviations
constexpr int kLeastBlocks = 3;       // fewest blocks of a direction before its levels are used
constexpr double kDeadShare = 0.003;  // smallest change that is installed / level of the file
constexpr double kRamp_vps = 1;       // largest rate of change of a level in use
constexpr int kRefused = 5;           // consecutive refused blocks after which the friction counts as changed
constexpr int kFrozenMoves = 2;       // moves without learning after a roll-back
constexpr int kJudgedBlocks = 4;      // fewest blocks of a move that judges the levels in use
// Largest standard deviation of a level that is used / level of the file.
constexpr double kExcitedShare = 0.06;
// A level falls during a motion when the compensation exceeds the friction of kLowerBlocks consecutive blocks
// by kLowerMargin standard deviations plus kLowerShare of the Coulomb level of the file.
constexpr double kLowerMargin = 2, kLowerShare = 0.01;
constexpr int kLowerBlocks = 2;
// An oscillation lowers a level to kCeilingCut times the known friction; where the friction is not
// known, to kLeastUnknown times the level of the file. One oscillation lowers a level by at most
// the factor kCeilingCut.
constexpr double kCeilingCut = 0.9, kLeastUnknown = 0.75;
constexpr double kCeilingRise = 1.02;  // factor of the largest permitted level per move without oscillation
// The previous levels return when the rms residual of the levels in use exceeds kWorse times that of the
// previous levels plus kWorse_v.
constexpr double kWorse = 1.5, kWorse_v = 0.03;

constexpr std::size_t direction_of(double speed) { return speed > 0 ? 0 : 1; }
double squared_v(double value) noexcept { return value * value; }

}  // namespace

AxisAdaptation::AxisAdaptation(const Design& design, std::size_t axis)
    : axis_{axis},
      adapts_{design.adaptation.enabled && design.friction[axis].factor > 0 &&
              std::min(design.friction[axis].coulomb_positive_v, design.friction[axis].coulomb_negative_v) >
                  0},
      zero_band_{design.friction[axis].zero_band_mps},
      share_{design.adaptation.friction_share},
      viscous_share_{design.adaptation.viscous_share},
      period_s_{design.period_s},
      gain_{axis == kTrolley ? design.crane.trolley_gain_mps2pv : design.crane.slew_gain_radps2pv},
      friction_{design.friction[axis]},
      break_away_{friction_, share_},
      limit_cycle_{zero_band_, period_s_} {
  rig_levels_ = {
      {{friction_.coulomb_positive_v, friction_.viscous_positive_vspm, friction_.stiction_positive_v},
       {friction_.coulomb_negative_v, friction_.viscous_negative_vspm, friction_.stiction_negative_v}}};
  active_levels_ = target_ = previous_levels_ = rig_levels_;
  ceiling_.fill(1 + share_);
}

void AxisAdaptation::step(const AxisBalance* balance, AdaptationFreeze reason, LevelFilter& filter) noexcept {
  if (!adapts_) return;
  approach_target();
  report_.freeze = reason;
  if (balance == nullptr || reason != AdaptationFreeze::none) {
    leave_block();
    break_away_.leave_rest();
    skipped_ticks_ = 0;
    limit_cycle_.reset();
    if (balance == nullptr) report_.freeze = AdaptationFreeze::gap;
    speed_ = balance == nullptr ? 0 : std::abs(balance->speed);
    moves_ = speed_ > kLearnBands * zero_band_;
  } else {
    speed_ = std::abs(balance->speed);
    // the mean acceleration of a block is the difference of two speeds divided by its duration
    const double noise = filter.noise_v(axis_) * gain_ * kBlock_ticks * period_s_ / std::numbers::sqrt2;
    if (limit_cycle_.step(balance->speed, noise)) lower_after_oscillation(filter);
    moves_ = std::abs(limit_cycle_.mean_speed()) > kLearnBands * zero_band_;
    report_.freeze = held_;
    learn(*balance, filter);
  }
  report_.phase =
      report_.freeze == AdaptationFreeze::none ? AdaptationPhase::learning : AdaptationPhase::frozen;
  describe(filter);
}

void AxisAdaptation::learn(const AxisBalance& balance, LevelFilter& filter) noexcept {
  const std::size_t direction = direction_of(balance.speed);
  if (speed_ <= zero_band_) return rest(balance, filter);
  if (break_away_.rested() && held_ == AdaptationFreeze::none &&
      report_.direction[direction].blocks >= kLeastBlocks &&
      break_away_.learn(direction, filter.coulomb_v(axis_, direction).value, filter.scatter_v(axis_)))
    ++report_.direction[direction].break_aways;
  break_away_.leave_rest();
  if (speed_ <= kLearnBands * zero_band_) {
    leave_block();
    skipped_ticks_ = 0;
    if (held_ == AdaptationFreeze::none) report_.freeze = AdaptationFreeze::standstill;
    return;
  }
  if (direction != block_direction_) leave_block(), skipped_ticks_ = 0;
  const double side = direction == 0 ? 1 : -1;
  block_direction_ = direction;
  if (++skipped_ticks_ <= kSkipped_ticks) return;
  skipped_ticks_ = kSkipped_ticks;
  block_.free_v += side * balance.free_v;
  block_.load_vpkg += side * balance.load_vpkg;
  block_.inertia_v += side * balance.inertia_v;
  block_.speed += speed_;
  if (++block_ticks_ == kBlock_ticks) finish_block(filter);
  if (refused_in_a_row_ > 0 && report_.freeze == AdaptationFreeze::none)
    report_.freeze = AdaptationFreeze::implausible;
}

void AxisAdaptation::rest(const AxisBalance& balance, const LevelFilter& filter) noexcept {
  leave_block();
  skipped_ticks_ = 0;
  if (held_ == AdaptationFreeze::none) report_.freeze = AdaptationFreeze::standstill;
  const double friction_v = filter.friction_v(
      axis_, {.free_v = balance.free_v, .load_vpkg = balance.load_vpkg, .inertia_v = balance.inertia_v});
  break_away_.rest(friction_v, speed_);
}

void AxisAdaptation::finish_block(LevelFilter& filter) noexcept {
  Block mean = block_;
  for (double* value : {&mean.free_v, &mean.load_vpkg, &mean.inertia_v, &mean.speed}) *value /= kBlock_ticks;
  leave_block();
  const std::size_t d = block_direction_;
  const auto innovation = filter.innovation(axis_, d, mean);
  report_.innovation_v = innovation.value_v;
  report_.innovation_std_v = innovation.deviation_v;
  const double friction_v = filter.friction_v(axis_, mean);
  const auto missed = [&](const FrictionLevels& levels) {
    return squared_v(friction_v - levels.coulomb_v - levels.viscous_vspm * mean.speed);
  };
  active_squares_ += missed(active_levels_[d]);
  previous_squares_ += missed(previous_levels_[d]);
  ++judged_blocks_;
  if (held_ != AdaptationFreeze::none) return;
  if (!innovation.plausible) {
    ++report_.refused_blocks;
    if (++refused_in_a_row_ < kRefused) return;
    filter.forget(axis_, d);
  }
  refused_in_a_row_ = 0;
  filter.update(axis_, d, mean);
  at_bound_[d] = at_bound_[d] || filter.payload_at_bound();
  ++report_.direction[d].blocks;
  lower(d, mean.speed, filter);
}

bool AxisAdaptation::excited(std::size_t direction, const LevelFilter& filter) const noexcept {
  return report_.direction[direction].blocks >= kLeastBlocks &&
         filter.coulomb_v(axis_, direction).std_dev <= kExcitedShare * rig_levels_[direction].coulomb_v;
}

FrictionLevels AxisAdaptation::wanted(std::size_t direction, const LevelFilter& filter) const noexcept {
  const FrictionLevels& file = rig_levels_[direction];
  const Estimated c = filter.coulomb_v(axis_, direction), b = filter.viscous_vspm(axis_, direction);
  const BreakAway::Excess& excess = break_away_.excess(direction);
  const double lowest = 1 - share_, highest = std::min(1 + share_, ceiling_[direction]);
  FrictionLevels levels;
  levels.coulomb_v =
      std::clamp(c.value - kMargin * c.std_dev, lowest * file.coulomb_v, highest * file.coulomb_v);
  levels.viscous_vspm =
      std::clamp(b.value, (1 - viscous_share_) * file.viscous_vspm, (1 + viscous_share_) * file.viscous_vspm);
  const double certain_excess =
      excess.value_v - kMargin * std::sqrt(excess.variance + squared_v(c.std_dev)) + kMargin * c.std_dev;
  const double static_v = levels.coulomb_v + std::max(0.0, certain_excess);
  levels.static_v = std::clamp(static_v, lowest * file.static_v, highest * file.static_v);
  return levels;
}

void AxisAdaptation::lower(std::size_t d, double speed, const LevelFilter& filter) noexcept {
  if (report_.direction[d].blocks < kLeastBlocks) return;
  FrictionLevels& target = target_[d];
  const Estimated shown = filter.moving_v(axis_, d, speed);
  const double compensated_v = target.coulomb_v + target.viscous_vspm * speed;
  const double least_v = shown.value + kLowerMargin * shown.std_dev + kLowerShare * rig_levels_[d].coulomb_v;
  excess_blocks_ = compensated_v > least_v ? excess_blocks_ + 1 : 0;
  if (excess_blocks_ < kLowerBlocks) return;
  const double kept = std::max(shown.value / compensated_v, 0.0);
  target.coulomb_v = std::max(kept * target.coulomb_v, (1 - share_) * rig_levels_[d].coulomb_v);
  target.static_v = std::max(kept * target.static_v, (1 - share_) * rig_levels_[d].static_v);
  target.viscous_vspm =
      std::max(kept * target.viscous_vspm, (1 - viscous_share_) * rig_levels_[d].viscous_vspm);
  on_trial_ = true;
}

void AxisAdaptation::lower_after_oscillation(const LevelFilter& filter) noexcept {
  ++report_.limit_cycles;
  for (std::size_t d = 0; d < 2; ++d) {
    FrictionLevels& target = target_[d];
    // A level above that of the file was learnt where the friction is larger than here.
    target.static_v = std::min(target.static_v, rig_levels_[d].static_v);
    target.coulomb_v = std::min(target.coulomb_v, rig_levels_[d].coulomb_v);
    if (on_trial_ && previous_levels_[d].static_v < target.static_v)
      target.static_v = previous_levels_[d].static_v;
    if (on_trial_ && previous_levels_[d].coulomb_v < target.coulomb_v)
      target.coulomb_v = previous_levels_[d].coulomb_v;
    // a level of at most kCeilingCut of the known friction cannot cause an oscillation
    const bool known = excited(d, filter);
    const double coulomb_v =
        known ? kCeilingCut * filter.coulomb_v(axis_, d).value : kLeastUnknown * rig_levels_[d].coulomb_v;
    const double static_v = known ? coulomb_v : kLeastUnknown * rig_levels_[d].static_v;
    target.static_v = std::max(kCeilingCut * target.static_v, std::min(static_v, target.static_v));
    target.coulomb_v = std::max(kCeilingCut * target.coulomb_v, std::min(coulomb_v, target.coulomb_v));
    const double kept =
        std::max(target.coulomb_v / rig_levels_[d].coulomb_v, target.static_v / rig_levels_[d].static_v);
    ceiling_[d] = std::max(1 - share_, std::min(ceiling_[d], kept));
    target.static_v = std::max(target.static_v, (1 - share_) * rig_levels_[d].static_v);
    target.coulomb_v = std::max(target.coulomb_v, (1 - share_) * rig_levels_[d].coulomb_v);
  }
  on_trial_ = false;
  previous_levels_ = target_;
  held_ = AdaptationFreeze::limit_cycle;
  frozen_moves_ = 1;
}

void AxisAdaptation::judge(LevelFilter& filter) noexcept {
  const double active_v = std::sqrt(active_squares_ / judged_blocks_);
  const double previous_v = std::sqrt(previous_squares_ / judged_blocks_);
  report_.move_residual_v = active_v;
  report_.previous_residual_v = previous_v;
  if (on_trial_ && active_v > kWorse * previous_v + kWorse_v) {
    target_ = previous_levels_;
    ++report_.roll_backs;
    held_ = AdaptationFreeze::rolled_back;
    frozen_moves_ = kFrozenMoves;
    for (std::size_t d = 0; d < 2; ++d) filter.forget(axis_, d);
  } else {
    previous_levels_ = target_;
  }
  on_trial_ = false;
}

void AxisAdaptation::end_move(LevelFilter& filter) noexcept {
  if (!adapts_) return;
  if (held_ != AdaptationFreeze::none && --frozen_moves_ <= 0) held_ = AdaptationFreeze::none;
  if (judged_blocks_ >= kJudgedBlocks) judge(filter);
  active_squares_ = previous_squares_ = 0;
  judged_blocks_ = 0;
  if (held_ != AdaptationFreeze::none) return;
  bool changed = false;
  for (std::size_t d = 0; d < 2; ++d) {
    ceiling_[d] = std::min(1 + share_, ceiling_[d] * kCeilingRise);
    if (std::exchange(at_bound_[d], false)) {
      filter.restart(axis_, d);
      continue;
    }
    if (!excited(d, filter)) continue;
    const FrictionLevels levels = wanted(d, filter);
    if (std::abs(levels.coulomb_v - target_[d].coulomb_v) < kDeadShare * rig_levels_[d].coulomb_v &&
        std::abs(levels.static_v - target_[d].static_v) < kDeadShare * rig_levels_[d].static_v &&
        std::abs(levels.viscous_vspm - target_[d].viscous_vspm) <= kDeadShare * rig_levels_[d].viscous_vspm)
      continue;
    target_[d] = levels;
    changed = true;
  }
  if (!changed) return;
  on_trial_ = true;
  ++report_.installed;
}

void AxisAdaptation::approach_target() noexcept {
  const double most = kRamp_vps * period_s_;
  for (std::size_t d = 0; d < 2; ++d)
    for (auto level : {&FrictionLevels::coulomb_v, &FrictionLevels::viscous_vspm, &FrictionLevels::static_v})
      active_levels_[d].*level += std::clamp(target_[d].*level - active_levels_[d].*level, -most, most);
  friction_.coulomb_positive_v = active_levels_[0].coulomb_v;
  friction_.coulomb_negative_v = active_levels_[1].coulomb_v;
  friction_.viscous_positive_vspm = active_levels_[0].viscous_vspm;
  friction_.viscous_negative_vspm = active_levels_[1].viscous_vspm;
  friction_.stiction_positive_v = active_levels_[0].static_v;
  friction_.stiction_negative_v = active_levels_[1].static_v;
}

void AxisAdaptation::describe(const LevelFilter& filter) noexcept {
  double known = 0;
  for (std::size_t d = 0; d < 2; ++d) {
    const Estimated c = filter.coulomb_v(axis_, d), b = filter.viscous_vspm(axis_, d);
    DirectionReport& shown = report_.direction[d];
    const BreakAway::Excess& excess = break_away_.excess(d);
    shown.estimate = {c.value, b.value, c.value + excess.value_v};
    shown.std_dev = {c.std_dev, b.std_dev, std::sqrt(squared_v(c.std_dev) + excess.variance)};
    shown.used = active_levels_[d];
    const double prior = filter.prior_coulomb_deviation(axis_, d);
    if (prior > 0) known += std::clamp(1 - c.std_dev / prior, 0.0, 1.0) / 2;
  }
  report_.confidence = known;
}

}  // namespace crane::control::adaptation
