#include "crane/diagnosis/replay.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parallel.hpp"
#include "replay/crane_on_run.hpp"

namespace crane::diagnosis {

const char* name_of(Part part) {
  return std::array{"whole", "drive", "load"}[static_cast<std::size_t>(part)];
}

std::vector<Output> simulated_outputs(const PreparedRun& run, Part part) {
  std::vector<Output> outputs;
  for (const Output output : kAllOutputs) {
    const bool drive = output == kTrolleyPosition || output == kSlewAngle;
    if (!run.run.has(output) || (drive && !run.run.commanded[output])) continue;
    if (part == Part::whole || (part == Part::drive) == drive) outputs.push_back(output);
  }
  return outputs;
}

Replay::Replay(const PreparedRun& run, const Crane& crane)
    : crane_on_run_(std::make_unique<CraneOnRun>(run, crane)) {}
Replay::~Replay() = default;
Replay::Replay(Replay&&) noexcept = default;

std::size_t Replay::start_size(Part part) const {
  return 2 * (simulated_outputs(crane_on_run_->source, part).size() + crane_on_run_->ringing.size());
}

std::vector<double> Replay::measured_start(Part part, std::size_t first) const {
  std::vector<double> start;
  for (const Output output : simulated_outputs(crane_on_run_->source, part)) {
    const Motion& motion = crane_on_run_->prescribed_motion(output);
    start.push_back(motion.position[first]);
    start.push_back(motion.rate[first]);
  }
  for (const std::size_t i : crane_on_run_->ringing) {
    start.push_back(crane_on_run_->inner_at[first][i].position);
    start.push_back(crane_on_run_->inner_at[first][i].rate);
  }
  return start;
}

std::vector<double> Replay::inner_start_scale() const {
  std::vector<double> scale;
  for (const std::size_t i : crane_on_run_->ringing) {
    double position = 0, rate = 0;
    for (const plant::InnerState& at : crane_on_run_->inner_at)
      position += at[i].position * at[i].position, rate += at[i].rate * at[i].rate;
    const auto rows = static_cast<double>(crane_on_run_->inner_at.size());
    scale.push_back(std::sqrt(position / rows));
    scale.push_back(std::sqrt(rate / rows));
  }
  return scale;
}

/// Outputs of a window at the rows' own times: constant acceleration inside the step that contains the time.
/// Sensor errors are known at the grid's times and interpolated linearly.
struct Replay::RowTimeOutputs {
  RowTimeOutputs(const Run& measured, std::size_t first_row, std::span<const Output> simulated,
                 std::span<double> values)
      : run(measured),
        first(first_row),
        rows(values.size() / simulated.size()),
        outputs(simulated),
        out(values) {
    added.assign(values.size(), 0.0);
  }

  void begin_step(const plant::State& state) { before = state; }
  /// @param step of `steps` after `row`. @param after state at its end
  void end_step(std::size_t row, int step, int steps, plant::State after) {
    const double step_s = run.period_s / steps;
    for (const std::size_t near : {row, row + 1}) {
      if (near < first || near >= first + rows) continue;
      const double offset_s = run.offset_s[near];
      const bool before_all = near == first && row == first && offset_s < 0;
      if (!before_all && (near == row) != (offset_s >= 0)) continue;
      const double from_row_s = near == row ? offset_s : offset_s + run.period_s;
      if (step != std::clamp(static_cast<int>(from_row_s / step_s), 0, steps - 1)) continue;
      const double t = from_row_s - step * step_s;
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        const double rate = rate_of(before, outputs[i]);
        const double acceleration = (rate_of(after, outputs[i]) - rate) / step_s;
        out[i * rows + near - first] = position_of(before, outputs[i]) + t * (rate + 0.5 * t * acceleration);
      }
    }
  }
  /// True if the steps before the row have set its outputs, because the row was measured before its grid
  /// time.
  [[nodiscard]] bool evaluated(std::size_t row) const { return row > first && run.offset_s[row] < 0; }
  /// @param reported,at sensor value and coordinate of output i at the grid's time of `row`
  void add_sensor_error(std::size_t row, std::size_t i, double reported, double at) {
    if (row - first < rows) added[i * rows + row - first] = reported - at;
  }
  void interpolate_sensor_errors() {
    for (std::size_t i = 0; i < outputs.size(); ++i)
      for (std::size_t k = 0; k < rows; ++k) {
        const double offset_s = run.offset_s[first + k];
        const std::size_t other = offset_s < 0 ? k - std::min<std::size_t>(k, 1) : std::min(k + 1, rows - 1);
        const double share = std::abs(offset_s) / run.period_s;
        out[i * rows + k] += (1 - share) * added[i * rows + k] + share * added[i * rows + other];
      }
  }

  const Run& run;
  std::size_t first, rows;
  std::span<const Output> outputs;
  std::span<double> out;
  std::vector<double> added;
  plant::State before;
};

void Replay::run(Part part, std::size_t first, std::size_t rows, std::span<const double> start,
                 std::span<double> out, std::vector<double>* end) const {
  const CraneOnRun& p = *crane_on_run_;
  const double period_s = p.source.run.period_s;
  const std::vector<Output> outputs = simulated_outputs(p.source, part);
  if (outputs.empty()) return;
  std::array<bool, kOutputs> simulated{};
  for (const Output output : outputs) simulated[output] = true;
  StepIntegrator integrator(p.model, simulated, p.locks(simulated), p.step_s());
  std::optional<RowTimeOutputs> row_times;
  if (!p.source.run.offset_s.empty()) row_times.emplace(p.source.run, first, outputs, out);
  const auto pass = [&](std::size_t row) {
    p.visit_steps(row, [&](int step, const plant::PerAxis& volts, bool changed) {
      if (changed) integrator.new_command(volts);
      const double middle = (step + 0.5) / p.steps;
      for (std::size_t i = 0; i < integrator.prescribed.size(); ++i)
        if (integrator.prescribed[i])
          integrator.prescribed_at[i] = between(p.inner[i], row, middle, period_s);
      if (row_times) row_times->begin_step(integrator.state);
      integrator.step(p.mid_step(row, step));
      if (row_times) row_times->end_step(row, step, p.steps, integrator.state);
    });
    integrator.prescribe(p.measured_at(row + 1));
  };
  integrator.prescribe(p.measured_at(first));
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    position_of(integrator.state, outputs[i]) = start[2 * i];
    rate_of(integrator.state, outputs[i]) = start[2 * i + 1];
  }
  if (!p.inner_at.empty()) integrator.inner = p.inner_at[first];
  if (part == Part::load) integrator.prescribed = p.prescribed;
  for (std::size_t i = 0, at = 2 * outputs.size(); at < start.size(); ++i, at += 2)
    integrator.inner[p.ringing[i]] = {start[at], start[at + 1]};
  std::optional<plant::Model> sensing;
  if (p.sensors) {
    sensing.emplace(p.crane.parameters, p.crane.terms, period_s);
    p.warm_up_sensors(*sensing, first);
  }
  for (std::size_t k = 0; k < rows; ++k) {
    if (sensing) {
      const plant::Measurement reported = sensing->measure(integrator.state);
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        const double value = measured_of(reported, outputs[i]);
        if (row_times)
          row_times->add_sensor_error(first + k, i, value, position_of(integrator.state, outputs[i]));
        else
          out[i * rows + k] = value;
      }
    }
    if (row_times ? !row_times->evaluated(first + k) : !sensing)
      for (std::size_t i = 0; i < outputs.size(); ++i)
        out[i * rows + k] = position_of(integrator.state, outputs[i]);
    if (k + 1 == rows && end != nullptr) {
      end->clear();
      for (const Output output : outputs)
        end->insert(end->end(), {position_of(integrator.state, output), rate_of(integrator.state, output)});
      for (const std::size_t i : p.ringing)
        end->insert(end->end(), {integrator.inner[i].position, integrator.inner[i].rate});
    }
    // A time after the grid's of the last row needs one more interval.
    const bool beyond = row_times && k + 1 == rows && p.source.run.offset_s[first + k] > 0;
    if (k + 1 == rows && !(beyond && first + k + 1 < p.source.run.rows())) break;
    pass(first + k);
  }
  if (row_times) row_times->interpolate_sensor_errors();
}

const Replay::Increments& Replay::increments_along_measurement(Output axis) const {
  std::call_once(crane_on_run_->increments_known, [this] { crane_on_run_->compute_increments(); });
  return *crane_on_run_->increments[axis];
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
