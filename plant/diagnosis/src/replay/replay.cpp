#include "crane/diagnosis/replay.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parallel.hpp"
#include "replay/parts.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kSmoothing_s = 0.03;

/// Standard deviation of a value that is rounded to whole counts. What has no encoder is known to this.
std::array<double, kOutputs> noise_of_counts(const configuration::Rig& rig) {
  constexpr double kLeast = 1e-7;
  constexpr std::array<std::size_t, kOutputs> kEncoders{0, 1, 3, 4};
  std::array<double, kOutputs> noise{};
  for (std::size_t i = 0; i < kOutputs; ++i) {
    const double counts = rig.encoders[kEncoders[i]].counts_per_unit;
    noise[i] = counts > 0 ? std::max(kLeast, 1 / (counts * std::sqrt(12.0))) : kLeast;
  }
  return noise;
}

}  // namespace

/// A drive's motion is not smoothed: that would take away from what excites the swing, a thousandth of the
/// amplitude already with second differences of neighbours.
Motion motion_of(Output output, const std::vector<double>& measured, double period_s) {
  const bool drive = output == kTrolleyPosition || output == kSlewAngle;
  return drive ? spline(measured, period_s) : smooth(measured, period_s, smoothing_half_width(period_s));
}

const char* name_of(Part part) {
  return std::array{"whole", "drive", "load"}[static_cast<std::size_t>(part)];
}

int smoothing_half_width(double period_s) {
  return std::max(3, static_cast<int>(std::lround(kSmoothing_s / period_s)));
}

PreparedRun prepare(Run run, const configuration::Rig& rig) {
  PreparedRun prepared;
  for (std::size_t i = 0; i < kOutputs; ++i)
    if (!run.measured[i].empty())
      prepared.motion[i] = motion_of(static_cast<Output>(i), run.measured[i], run.period_s);
  prepared.cable = smooth(run.cable_m, run.period_s, smoothing_half_width(run.period_s));
  for (const bool inner : {false, true})
    prepared.half_way[inner ? 1 : 0] =
        half_way_through_steps(prepared.motion, prepared.cable, steps_in(run.period_s, inner), run.period_s);
  prepared.kind = rig.kind;
  prepared.least_noise = noise_of_counts(rig);
  prepared.run = std::move(run);
  return prepared;
}

std::vector<Output> simulated_outputs(const PreparedRun& run, Part part) {
  std::vector<Output> outputs;
  for (const Output output : kAllOutputs) {
    const bool drive = output == kTrolleyPosition || output == kSlewAngle;
    if (run.run.has(output) && (part == Part::whole || (part == Part::drive) == drive))
      outputs.push_back(output);
  }
  return outputs;
}

Replay::Replay(const PreparedRun& run, const Crane& crane) : parts_(std::make_unique<Parts>(run, crane)) {}
Replay::~Replay() = default;
Replay::Replay(Replay&&) noexcept = default;

std::size_t Replay::start_size(Part part) const {
  return 2 * (simulated_outputs(parts_->source, part).size() + parts_->ringing.size());
}

std::vector<double> Replay::measured_start(Part part, std::size_t first) const {
  std::vector<double> start;
  for (const Output output : simulated_outputs(parts_->source, part)) {
    const Motion& motion = parts_->given(output);
    start.push_back(motion.position[first]);
    start.push_back(motion.rate[first]);
  }
  for (const std::size_t i : parts_->ringing) {
    start.push_back(parts_->inner_at[first][i].position);
    start.push_back(parts_->inner_at[first][i].rate);
  }
  return start;
}

void Replay::run(Part part, std::size_t first, std::size_t rows, std::span<const double> start,
                 std::span<double> out) const {
  const Parts& p = *parts_;
  const double period_s = p.source.run.period_s;
  const std::vector<Output> outputs = simulated_outputs(p.source, part);
  std::array<bool, kOutputs> simulated{};
  for (const Output output : outputs) simulated[output] = true;
  Course course(p.model, simulated, p.locks(simulated), p.step_s());
  const auto pass = [&](std::size_t row) {
    p.visit_steps(row, [&](int step, const plant::PerAxis& volts, bool changed) {
      if (changed) course.new_command(volts);
      const double middle = (step + 0.5) / p.steps;
      for (std::size_t i = 0; i < course.led.size(); ++i)
        if (course.led[i]) course.led_at[i] = between(p.inner[i], row, middle, period_s);
      course.step(p.half_way(row, step));
    });
    course.follow(p.measured_at(row + 1));
  };
  course.follow(p.measured_at(first));
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    position_of(course.state, outputs[i]) = start[2 * i];
    rate_of(course.state, outputs[i]) = start[2 * i + 1];
  }
  if (!p.inner_at.empty()) course.inner = p.inner_at[first];
  if (part == Part::load) course.led = p.led;
  for (std::size_t i = 0, at = 2 * outputs.size(); at < start.size(); ++i, at += 2)
    course.inner[p.ringing[i]] = {start[at], start[at + 1]};
  std::optional<plant::Model> sensing;
  if (p.sensors) sensing.emplace(p.crane.parameters, p.crane.terms, period_s);
  for (std::size_t k = 0; k < rows; ++k) {
    if (sensing) {
      const plant::Measurement reported = sensing->measure(course.state);
      for (std::size_t i = 0; i < outputs.size(); ++i) out[i * rows + k] = measured_of(reported, outputs[i]);
    } else {
      for (std::size_t i = 0; i < outputs.size(); ++i)
        out[i * rows + k] = position_of(course.state, outputs[i]);
    }
    if (k + 1 == rows) break;
    pass(first + k);
  }
}

Replay::Guided Replay::guided(Output axis) const {
  const Parts& p = *parts_;
  if (p.guided[axis]) return *p.guided[axis];
  const std::array<bool, kOutputs> none{};
  std::array<bool, kOutputs> drives{};
  for (const Output drive : simulated_outputs(p.source, Part::drive)) drives[drive] = true;
  Course course(p.model, none, p.locks(drives), p.source.run.period_s);
  const std::size_t rows = p.source.run.rows();
  const double h = p.step_s();
  Guided drive{p.given(axis).position, std::vector<double>(rows), std::vector<double>(rows)};
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    if (!p.inner_at.empty()) course.inner = p.inner_at[row];
    const Measured middle = p.measured_half_way(row);
    double acceleration = 0;
    p.visit_steps(row, [&](int, const plant::PerAxis& volts, bool changed) {
      if (changed) {
        course.new_command(volts);
        acceleration = acceleration_of(course.accelerations(middle), axis);
      }
      drive.move(row, acceleration, h);
    });
  }
  return drive;
}

Replays replays_of(const Runs& runs, const Crane& crane) {
  std::vector<std::optional<Replay>> made(runs.size());
  parallel_for(runs.size(), [&](std::size_t i) { made[i].emplace(runs[i], crane); });
  Replays replays;
  replays.reserve(made.size());
  for (auto& replay : made) replays.push_back(std::move(*replay));
  return replays;
}

}  // namespace crane::diagnosis
