#include "replay/crane_on_run.hpp"

#include <algorithm>
#include <cmath>

#include "crane/stepper/friction_step.hpp"
#include "data/grid.hpp"
#include "replay/standstill.hpp"

namespace crane::diagnosis {
namespace {

/// Ratio above which the change of a motor's speed from row to row that the model does not explain, over its
/// running median, is an impact.
constexpr double kImpactRatio = 15;

bool has_sensor_term(const Crane& crane) {
  return std::any_of(crane.terms.begin(), crane.terms.end(), [](const plant::TermSetting& term) {
    const plant::TermKind* kind = plant::find_term(term.name);
    return kind != nullptr && kind->acts_on == plant::ActsOn::sensor;
  });
}

/// The crane with the load of a run.
Crane loaded_as(const Run& run, Crane crane) {
  if (run.load_mass_kg > 0) crane.parameters.load_mass_kg = run.load_mass_kg;
  return crane;
}

/// Delay in s with which the sensors report a swing that increases linearly; 0 for drives. It is measured
/// after the memory of the sensor has been filled.
std::array<double, kOutputs> swing_delays_s(const Crane& crane, double period_s) {
  constexpr double kMemory_s = 1;      // bounds of swing_delay and swing_moving_average: 0.5 s each
  constexpr double kRate_radps = 0.1;  // any small rate: the sensor terms are linear
  std::array<double, kOutputs> delays_s{};
  for (const Output output : {kRadialSwing, kTangentialSwing}) {
    plant::Model sensing(crane.parameters, crane.terms, period_s);
    const auto reported_at = [&](double time_s) {
      plant::State at;
      position_of(at, output) = kRate_radps * time_s;
      return measured_of(sensing.measure(at), output);
    };
    const double at_rest = reported_at(0);
    double time_s = 0, last = at_rest, reported = at_rest;
    while (time_s < kMemory_s + period_s) {
      last = reported;
      reported = reported_at(time_s += period_s);
    }
    const double rate_radps = (reported - last) / period_s;
    if (rate_radps > 0) delays_s[output] = std::max(0.0, time_s - (reported - at_rest) / rate_radps);
  }
  return delays_s;
}

/// Adds to each value the error of the report `ticks` later, interpolated linearly. After the last report,
/// its error is used. @pre ticks >= 0
void add_earlier(const std::vector<double>& errors, double ticks, std::vector<double>& values) {
  const double whole = std::floor(ticks), share = ticks - whole;
  const auto later = static_cast<std::size_t>(whole);
  const auto error_at = [&](std::size_t row) { return errors[std::min(row, errors.size() - 1)]; };
  for (std::size_t row = 0; row < values.size(); ++row)
    values[row] += (1 - share) * error_at(row + later) + share * error_at(row + later + 1);
}

bool has_inner_coordinates(const Crane& crane) {
  return plant::Model(crane.parameters, crane.terms).inner_coordinates() > 0;
}

}  // namespace

Replay::CraneOnRun::CraneOnRun(const PreparedRun& prepared, const Crane& the_crane)
    : source(prepared),
      crane(loaded_as(prepared.run, the_crane)),
      steps(steps_in(prepared.run.period_s, has_inner_coordinates(crane))),
      model(crane.parameters, crane.terms, step_s()),
      sensors(has_sensor_term(crane)) {
  ringing = model.ringing_coordinates();
  std::fill_n(prescribed.begin(), model.inner_coordinates(), true);
  for (const std::size_t i : ringing) prescribed[i] = false;
  const auto in_a_row = static_cast<std::size_t>(steps), all = prepared.run.rows() * in_a_row;
  const bool fine = !prepared.run.commands.empty();
  const std::vector<plant::PerAxis> prescribed_motion =
      fine ? mean_commands(prepared.run.commands, step_s(), all) : std::vector<plant::PerAxis>{};
  drive_v.reserve(all);
  for (std::size_t at = 0; at < all; ++at)
    drive_v.push_back(
        model.drive_voltage(fine ? prescribed_motion[at] : prepared.run.command_v[at / in_a_row]));
  if (sensors) invert_sensors();
  if (model.inner_coordinates() > 0) simulate_inner_coordinates();
}

plant::Locks Replay::CraneOnRun::locks(const std::array<bool, kOutputs>& simulated) const {
  const bool loaded = crane.parameters.load_mass_kg > 0;
  plant::Locks locks;
  locks.axis = {!simulated[kTrolleyPosition], !simulated[kSlewAngle], true};
  locks.radial = !source.run.has(kRadialSwing) || !loaded;
  locks.tangential = !source.run.has(kTangentialSwing) || !loaded;
  return locks;
}

MeasuredKinematics Replay::CraneOnRun::measured_at(std::size_t row) const {
  MeasuredKinematics at;
  for (const Output output : kAllOutputs) at.output[output] = at_row(prescribed_motion(output), row);
  at.cable = at_row(source.cable, row);
  return at;
}

MeasuredKinematics Replay::CraneOnRun::measured_mid_row(std::size_t row) const {
  MeasuredKinematics at;
  for (const Output output : kAllOutputs)
    at.output[output] = between(prescribed_motion(output), row, 0.5, source.run.period_s);
  at.cable = between(source.cable, row, 0.5, source.run.period_s);
  return at;
}

/// Fixed-point iteration: each round adds the difference between the measurement and the report of the
/// modelled sensor to the values. The relative error of an encoder's scale is 1e-6 afterwards. For a swing,
/// the difference is shifted to earlier times by the delay of the sensor: without this shift, each round
/// would amplify the swing for a delay of more than a sixth of its period.
void Replay::CraneOnRun::invert_sensors() {
  constexpr int kRounds = 5;
  const Run& run = source.run;
  const std::array<std::vector<double>, kOutputs>& measured = source.on_grid;
  const std::array<double, kOutputs> delays_s = swing_delays_s(crane, run.period_s);
  std::array<std::vector<double>, kOutputs> values = measured, errors = measured;
  for (int round = 0; round < kRounds; ++round) {
    plant::Model fresh(crane.parameters, crane.terms, run.period_s);
    for (std::size_t k = 0; k < run.rows(); ++k) {
      plant::State at;
      for (const Output output : kAllOutputs)
        if (run.has(output)) position_of(at, output) = values[output][k];
      at.cable_m = run.cable_m[k];
      const plant::Measurement reported = fresh.measure(at);
      for (const Output output : kAllOutputs)
        if (run.has(output)) errors[output][k] = measured[output][k] - measured_of(reported, output);
    }
    for (const Output output : kAllOutputs)
      if (run.has(output)) add_earlier(errors[output], delays_s[output] / run.period_s, values[output]);
  }
  for (const Output output : kAllOutputs)
    if (run.has(output)) corrected[output] = motion_of(output, values[output], run.period_s);
  corrected_mid_step = mid_step_kinematics(corrected, source.cable, steps, run.period_s);
}

void Replay::CraneOnRun::warm_up_sensors(plant::Model& sensing, std::size_t row) const {
  constexpr double kLongestMemory_s = 0.5;  // of a mean over time (swing_moving_average)
  const auto memory = sensing.sensors_remember_motion()
                          ? row
                          : static_cast<std::size_t>(kLongestMemory_s / source.run.period_s);
  for (std::size_t k = row - std::min(row, memory); k < row; ++k) {
    plant::State at;
    for (const Output output : kAllOutputs)
      if (source.run.has(output)) position_of(at, output) = prescribed_motion(output).position[k];
    at.cable_m = source.run.cable_m[k];
    (void)sensing.measure(at);
  }
}

Replay::Increments Replay::CraneOnRun::empty_increments(Output axis) const {
  const std::size_t rows = source.run.rows();
  return {prescribed_motion(axis).position, std::vector<double>(rows), std::vector<double>(rows)};
}

void Replay::CraneOnRun::compute_increments() {
  std::vector<Output> missing;
  for (const Output axis : {kTrolleyPosition, kSlewAngle}) {
    if (!source.run.has(axis) || increments[axis]) continue;
    missing.push_back(axis);
    increments[axis] = empty_increments(axis);
  }
  if (missing.empty()) return;
  const std::array<bool, kOutputs> none{};
  std::array<bool, kOutputs> drives{};
  for (const Output drive : simulated_outputs(source, Part::drive)) drives[drive] = true;
  StepIntegrator integrator(model, none, locks(drives), source.run.period_s);
  for (std::size_t row = 0; row + 1 < source.run.rows(); ++row) {
    if (!inner_at.empty()) integrator.inner = inner_at[row];
    const MeasuredKinematics middle = measured_mid_row(row);
    plant::Accelerations accelerations;
    visit_steps(row, [&](int, const plant::PerAxis& volts, bool changed) {
      if (changed) {
        integrator.new_command(volts);
        accelerations = integrator.accelerations(middle);
      }
      for (const Output axis : missing)
        increments[axis]->add_step(row, acceleration_of(accelerations, axis), step_s());
    });
  }
}

/// Changes of the speeds of the motors from a row to the next row that only impacts explain.
plant::PerAxis Replay::CraneOnRun::impacts_after(std::size_t row, std::array<RunningMedian, 2>& usual) const {
  plant::PerAxis unexplained{};
  for (const Output axis : {kTrolleyPosition, kSlewAngle}) {
    if (!increments[axis]) continue;
    const double from = prescribed_motion(axis).rate[row], to = prescribed_motion(axis).rate[row + 1];
    if (std::abs(from) < kStandstillSpeed || std::abs(to) < kStandstillSpeed || from * to < 0) continue;
    const double change = to - from - increments[axis]->speed_change[row];
    if (std::abs(change) > kImpactRatio * usual[axis].value()) unexplained[axis] = change;
    usual[axis].take(std::abs(change));
  }
  return unexplained;
}

/// Simulates the inner coordinates along the measured motion of the whole run. The times of impacts in a gap
/// are chaotic; therefore impacts that are detected in the measured speed of the motors correct the
/// prescribed coordinates.
void Replay::CraneOnRun::simulate_inner_coordinates() {
  const std::array<bool, kOutputs> none{};
  std::array<bool, kOutputs> drives{};
  for (const Output drive : simulated_outputs(source, Part::drive)) drives[drive] = true;
  const bool correcting = std::find(prescribed.begin(), prescribed.end(), true) != prescribed.end();
  StepIntegrator integrator(model, none, locks(none), step_s()), motors(model, none, locks(drives), step_s());
  const std::size_t rows = source.run.rows();
  for (const Output axis : {kTrolleyPosition, kSlewAngle})
    if (correcting && drives[axis]) increments[axis] = empty_increments(axis);
  std::array<RunningMedian, 2> usual;
  integrator.prescribe(measured_at(0));
  for (std::size_t row = 0; row < rows; ++row) {
    inner_at.push_back(integrator.inner);
    if (row + 1 == rows) break;
    visit_steps(row, [&](int step, const plant::PerAxis& volts, bool changed) {
      const MeasuredKinematics& at = mid_step(row, step);
      if (changed) integrator.new_command(volts), motors.new_command(volts);
      if (correcting) {
        motors.inner = integrator.inner;
        const plant::Accelerations a = motors.accelerations(at);
        for (const Output axis : {kTrolleyPosition, kSlewAngle})
          if (drives[axis]) increments[axis]->add_step(row, acceleration_of(a, axis), step_s());
      }
      integrator.step(at);
    });
    integrator.prescribe(measured_at(row + 1));
    // A diverged coordinate is set to rest, so that all values remain finite. The fit is then poor.
    for (plant::Inner& coordinate : integrator.inner)
      if (!(std::abs(coordinate.rate) < stepper::kDivergedSpeed)) coordinate = {};
    if (!correcting) continue;
    model.correct(integrator.state, impacts_after(row, usual), inner_at.back(), integrator.inner);
  }
  for (std::size_t i = 0; i < model.inner_coordinates(); ++i) {
    if (!prescribed[i]) continue;
    std::vector<double> position;
    for (const plant::InnerState& at : inner_at) position.push_back(at[i].position);
    inner[i] = spline(position, source.run.period_s);
  }
}

}  // namespace crane::diagnosis
