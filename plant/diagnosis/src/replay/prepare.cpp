/// Measured motion of a run on the time grid of the simulation: smoothed motion and quantisation noise of
/// each output.
#include <algorithm>
#include <cmath>

#include "replay/crane_on_run.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kSmoothing_s = 0.03;

/// Standard deviation of the rounding error of each output. The step is the resolution of the data; if it is
/// unknown, one count of the encoder in the rig file.
std::array<double, kOutputs> quantisation_noise(const Run& run, const configuration::Rig& rig) {
  constexpr double kLeast = 1e-7;
  constexpr std::array<std::size_t, kOutputs> kEncoders{0, 1, 3, 4};
  std::array<double, kOutputs> noise{};
  for (std::size_t i = 0; i < kOutputs; ++i) {
    const double counts = rig.encoders[kEncoders[i]].counts_per_unit;
    const double step = run.resolution[i] > 0 ? run.resolution[i] : counts > 0 ? 1 / counts : 0;
    noise[i] = std::max(kLeast, step / std::sqrt(12.0));
  }
  return noise;
}

}  // namespace

/// A spline differentiates the position of a drive, because its acceleration excites the swing and smoothing
/// would reduce it. Second differences reduce it by 0.1 %.
Motion motion_of(Output output, const std::vector<double>& measured, double period_s) {
  const bool drive = output == kTrolleyPosition || output == kSlewAngle;
  return drive ? spline(measured, period_s)
               : savitzky_golay(measured, period_s, smoothing_half_width(period_s));
}

int smoothing_half_width(double period_s) {
  return std::max(3, static_cast<int>(std::lround(kSmoothing_s / period_s)));
}

namespace {

/// Measured values of an output, at their own times.
struct Samples {
  Samples(const Run& run, Output output) {
    for (std::size_t row = 0; row < run.rows(); ++row)
      if (run.is_measured(output, row)) {
        time_s.push_back(run.instant_s(row));
        values.push_back(run.measured[output][row]);
      }
  }
  std::vector<double> time_s, values;
};

/// The drive's acceleration excites the load: steps of a coarse encoder are smoothed first.
void prepare_drive(const Run& run, Output drive, PreparedRun& prepared) {
  const Samples samples(run, drive);
  const std::vector<double> smoothed =
      rts_smoothed(samples.time_s, samples.values, prepared.least_noise[drive]);
  prepared.motion[drive] = run.regular(drive) ? spline(smoothed, run.period_s)
                                              : spline_of(samples.time_s, smoothed, run.period_s, run.rows());
  prepared.on_grid[drive] = prepared.motion[drive].position;
}

}  // namespace

std::vector<double> measured_on_grid(const Run& run, Output output) {
  if (run.regular(output)) return run.measured[output];
  const Samples samples(run, output);
  return spline_of(samples.time_s, samples.values, run.period_s, run.rows()).position;
}

namespace {

/// A command that acts by dt too late or too early makes the speed wrong by gain * change of the command *
/// dt.
std::vector<double> speed_inaccuracy_of(const Run& run, std::size_t drive, double gain, double time_s) {
  std::vector<double> squares(run.rows(), 0.0);
  const auto add = [&](std::size_t row, double volts) { squares[row] += std::pow(gain * volts * time_s, 2); };
  if (run.commands.empty()) {
    for (std::size_t row = 1; row < run.rows(); ++row)
      add(row, run.command_v[row][drive] - run.command_v[row - 1][drive]);
  } else {
    for (std::size_t i = 1; i < run.commands.size(); ++i) {
      const double row =
          std::clamp(run.commands[i].time_s / run.period_s, 0.0, static_cast<double>(run.rows() - 1));
      add(static_cast<std::size_t>(row), run.commands[i].drive_v[drive] - run.commands[i - 1].drive_v[drive]);
    }
  }
  for (double& square : squares) square = std::sqrt(square);
  return squares;
}

}  // namespace

PreparedRun prepare(Run run, const configuration::Rig& rig, const Accuracy& accuracy) {
  PreparedRun prepared;
  const double time_s = accuracy.times_periods * rig.period_s;
  const std::array gains{rig.plant.trolley_gain_mps2pv, rig.plant.slew_gain_radps2pv};
  for (std::size_t drive = 0; time_s > 0 && drive < gains.size(); ++drive)
    prepared.speed_inaccuracy[drive] = speed_inaccuracy_of(run, drive, gains[drive], time_s);
  prepared.least_noise = quantisation_noise(run, rig);
  for (const Output output : kAllOutputs) {
    if (!run.has(output)) continue;
    if (output == kTrolleyPosition || output == kSlewAngle) {
      prepare_drive(run, output, prepared);
    } else {
      prepared.on_grid[output] = measured_on_grid(run, output);
      prepared.motion[output] = motion_of(output, prepared.on_grid[output], run.period_s);
    }
  }
  prepared.cable = savitzky_golay(run.cable_m, run.period_s, smoothing_half_width(run.period_s));
  for (const bool inner : {false, true})
    prepared.mid_step[inner ? 1 : 0] =
        mid_step_kinematics(prepared.motion, prepared.cable, steps_in(run.period_s, inner), run.period_s);
  prepared.rig_cable_m = rig.start.position[plant::kHoist];
  prepared.kind = rig.kind;
  prepared.run = std::move(run);
  return prepared;
}

double least_noise_of(const Runs& runs, Output output) {
  double most = 0;
  for (const PreparedRun& run : runs) most = std::max(most, run.least_noise[output]);
  return most;
}

}  // namespace crane::diagnosis
