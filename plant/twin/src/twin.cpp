#include "crane/twin/twin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace crane::twin {
namespace {

using stepper::kCoordinateOf;

constexpr double kLargestSwing_rad = 1.4, kShortestCable_m = 0.05;  // range of the equations of motion
constexpr PerColumn kMoving{0.005, 0.005, 0.02, 0.02};              // speed of a moving axis, m/s, rad/s
constexpr double kUnexpected = 0.25;  // largest error of the modelled acceleration / that by full voltage
constexpr double kFullVoltage_v = 10;
constexpr double kSmallestSlip_counts = 3;
constexpr double kQuietDrive = 4;  // largest residual of a drive that is not disturbed / its band

double resolution(const configuration::Rig& rig, std::size_t column) {
  const double counts = rig.encoders[kCoordinateOf[column]].counts_per_unit;
  return counts > 0 ? 1 / counts : 0;
}

/// Smallest standard deviation of a residual: one count.
PerColumn floor_of(const configuration::Rig& rig) {
  PerColumn floor{};
  for (std::size_t i = 0; i < kColumns; ++i) floor[i] = std::max(resolution(rig, i), 1e-7);
  return floor;
}

double least_jump(const configuration::Rig& rig, std::size_t column) {
  const PerColumn gain{rig.plant.trolley_gain_mps2pv, rig.plant.slew_gain_radps2pv, 0, 0};
  return kUnexpected * gain[column] * kFullVoltage_v * rig.period_s * rig.period_s +
         kSmallestSlip_counts * resolution(rig, column);
}

int ticks_in(double duration_s, const configuration::Rig& rig) {
  return std::max(1, static_cast<int>(std::lround(duration_s / rig.period_s)));
}

std::string with_axis(const std::string& cause, const std::string& axis) {
  return axis.empty() ? cause : cause + " (" + axis + ")";
}

std::string text(const char* format, double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

}  // namespace

Twin::Twin(const configuration::Rig& rig, const Design& design)
    : rig_(rig),
      design_(design),
      judge_(hypotheses_for(rig), design, floor_of(rig), ticks_in(design.block_s, rig)),
      nominal_(rig.plant, rig.terms, rig.period_s, design.horizon_s),
      settle_ticks_(ticks_in(design.settle_s, rig)),
      block_ticks_(ticks_in(design.block_s, rig)),
      block_(judge_.hypotheses().size()) {
  if (judge_.hypotheses().empty())
    throw std::invalid_argument(
        rig.path + ": the rig has no drive and no load, so that the twin has nothing to predict");
  for (const Hypothesis& hypothesis : judge_.hypotheses()) {
    auto terms = rig.terms;
    terms.insert(terms.end(), hypothesis.terms.begin(), hypothesis.terms.end());
    changed_.emplace_back(rig.plant, terms, rig.period_s, design.horizon_s, hypothesis.slip);
  }
  for (std::size_t i = 0; i < kColumns; ++i)
    steps_.emplace_back(rig.period_s, design.horizon_s, least_jump(rig, i));
}

MeasuredTick Twin::known(const Sample& sample) const {
  const auto coordinate = [&](std::size_t counter) {
    const auto& encoder = rig_.encoders[counter];
    return encoder.counts_per_unit > 0
               ? encoder.sign * static_cast<double>(sample.counts[counter]) / encoder.counts_per_unit -
                     encoder.rest_angle_rad
               : 0.0;
  };
  MeasuredTick now;
  for (std::size_t i = 0; i < kColumns; ++i) now.reported[i] = coordinate(kCoordinateOf[i]);
  now.rate = sample.rate;
  const bool measured = rig_.measures(plant::kHoist);
  now.cable_m = (measured ? coordinate(plant::kHoist) : rig_.start.position[plant::kHoist]) +
                rig_.start.cable_length_offset_m;
  now.cable_mps = measured ? sample.cable_mps : 0;
  return now;
}

Mask Twin::free_columns(const Sample& sample) const {
  const auto has = [&](std::size_t column) { return rig_.measures(kCoordinateOf[column]); };
  const bool load = rig_.has_load();
  return {rig_.drives[0].present && has(0) && !sample.held[0],
          rig_.drives[1].present && has(1) && !sample.held[1], load && has(2),
          load && has(3) && rig_.kind == configuration::RigKind::tower};
}

bool Twin::usable(const Sample& sample, const MeasuredTick& now) const {
  bool finite = std::isfinite(sample.cable_mps);
  for (const double value : sample.rate) finite = finite && std::isfinite(value);
  for (const double value : sample.applied_v) finite = finite && std::isfinite(value);
  return finite && now.cable_m > kShortestCable_m && std::abs(now.reported[2]) < kLargestSwing_rad &&
         std::abs(now.reported[3]) < kLargestSwing_rad;
}

bool Twin::follows(const Sample& sample) const {
  return last_ && sample.epoch == last_->epoch && sample.tick == last_->tick + 1;
}

const Judgement& Twin::step(const Sample& sample) {
  if (last_ && sample.epoch == last_->epoch && sample.tick <= last_->tick) return judgement_;
  const MeasuredTick now = known(sample);
  if (!sample.homed || !usable(sample, now)) {
    if (sample.homed) ++judgement_.gaps;
    last_.reset();
    report();
    return judgement_;
  }
  const Mask wanted = free_columns(sample);
  if (!follows(sample) || wanted != simulated_) {
    if (last_ && !follows(sample)) ++judgement_.gaps;
    simulated_ = wanted;
    restart(sample, now);
  } else {
    predict(now);
  }
  last_ = sample;
  report();
  return judgement_;
}

void Twin::restart(const Sample& sample, const MeasuredTick& now) {
  last_ = sample;
  nominal_.restart(now, simulated_);
  for (Predictor& predictor : changed_) predictor.restart(now, simulated_);
  for (StepWatch& watch : steps_) watch.restart();
  to_settle_ = settle_ticks_;
  block_ = Block(changed_.size());
  complete_block_.reset();
  judgement_.predicted = now.reported;
  judgement_.residual = {};
}

void Twin::predict(const MeasuredTick& now) {
  judgement_.predicted = nominal_.predict(last_->applied_v, now);
  bool finite = true;
  for (std::size_t i = 0; i < kColumns; ++i) {
    judgement_.residual[i] = now.reported[i] - judgement_.predicted[i];
    finite = finite && std::isfinite(judgement_.residual[i]);
  }
  for (Predictor& predictor : changed_) predictor.predict(last_->applied_v, now);
  if (!finite) {
    ++judgement_.gaps;
    restart(*last_, now);
    return;
  }
  if (to_settle_ > 0)
    --to_settle_;
  else
    accumulate(now);
  nominal_.correct(now.reported);
  for (Predictor& predictor : changed_) predictor.correct(now.reported);
  if (to_settle_ == 0) watch_steps();
  if (block_.ticks < block_ticks_) return;
  if (complete_block_) judge_.add(*complete_block_);
  complete_block_ = std::move(block_);
  block_ = Block(changed_.size());
}

void Twin::accumulate(const MeasuredTick& now) {
  ++block_.ticks;
  ++judgement_.judged_ticks;
  bool moving = false;
  for (std::size_t i = 0; i < kColumns; ++i) {
    if (!simulated_[i]) continue;
    const double e = judgement_.residual[i];
    block_.energy[i] += e * e;
    moving = moving || std::abs(now.rate[i]) > kMoving[i];
    for (std::size_t c = 0; c < changed_.size(); ++c) {
      const double phi = changed_[c].predicted()[i] - judgement_.predicted[i];
      block_.score[c][i] += phi * e;
      block_.information[c][i] += phi * phi;
    }
  }
  if (moving) ++block_.moving_ticks;
}

/// A push of the load changes the residual of the drives only through the force of the load.
bool Twin::could_be_push(std::size_t column) const {
  bool drives_quiet = true;
  for (const auto drive : {stepper::kTrolleyPosition, stepper::kSlewAngle})
    drives_quiet = drives_quiet && std::abs(judgement_.residual[drive]) <= kQuietDrive * judge_.band()[drive];
  return drives_quiet && column >= stepper::kRadialSwing;
}

void Twin::watch_steps() {
  for (std::size_t i = 0; i < kColumns; ++i) {
    if (!simulated_[i]) continue;
    const auto step = steps_[i].add(judgement_.residual[i], judge_.phase() == Phase::learning);
    if (!step || (step->kind == StepKind::push && !could_be_push(i))) continue;
    Finding finding;
    const bool slip = step->kind == StepKind::slip;
    finding.cause = slip ? kEncoderSlip : kLoadPushed;
    finding.axis = coordinate_of(i).axis;
    finding.unit = slip ? coordinate_of(i).unit : "rad/s";
    finding.size = step->size;
    finding.remedy = cause_kind(finding.cause).remedy;
    finding.column = i;
    judge_.found(finding);
    // The residual of a step must not count as evidence for another cause.
    block_ = Block(changed_.size());
    complete_block_.reset();
    to_settle_ = settle_ticks_ / 2;
    for (StepWatch& watch : steps_) watch.restart();
    return;
  }
}

void Twin::report() {
  const Phase phase = judge_.phase();
  judgement_.band = judge_.band();
  judgement_.evidence = judge_.evidence();
  judgement_.learnt_share = judge_.learnt_share();
  judgement_.state = phase == Phase::deviates   ? State::deviates
                     : !last_ || to_settle_ > 0 ? State::waiting
                     : phase == Phase::learning ? State::learning
                                                : State::watching;
  const auto& finding = judge_.finding();
  judgement_.cause = finding ? finding->cause : "";
  judgement_.axis = finding ? finding->axis : "";
  judgement_.unit = finding ? finding->unit : "";
  judgement_.size = finding ? finding->size : 0;
  judgement_.size_std = finding ? finding->size_std : 0;
  announce();
}

void Twin::announce() {
  const auto& finding = judge_.finding();
  if (!announced_ && finding && judge_.named()) {
    announced_ = true;
    std::string what = std::string{coordinate_of(finding->column).column} + " has left its band of +-" +
                       text("%.3g ", judgement_.band[finding->column]) + coordinate_of(finding->column).unit +
                       ": likely " + with_axis(finding->cause, finding->axis);
    if (!finding->unit.empty()) what += text(" %+.3g", finding->size);
    if (finding->size_std > 0) what += text(" +- %.1g", finding->size_std);
    if (!finding->unit.empty()) what += " " + finding->unit;
    if (!finding->rival.empty()) what += ", or " + finding->rival;
    notice_ = Notice{true, what, finding->remedy};
  } else if (announced_ && !finding) {
    announced_ = false;
    notice_ = Notice{false, "the residual is within its band again", ""};
  }
}

std::optional<Notice> Twin::take_notice() {
  auto notice = std::move(notice_);
  notice_.reset();
  return notice;
}

}  // namespace crane::twin
