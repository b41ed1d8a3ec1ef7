#pragma once
/// Replay: simulation with prescribed motion (docs/diagnosis_method.md, 1). Independent of services/replay.
///   whole  command -> positions and swing; nothing is prescribed
///   drive  command and measured swing -> positions; a large residual indicates an error of drive or friction
///   load   measured motion -> swing; a large residual indicates an error of the load or its sensors
///
/// Fixed leapfrog steps (plant/stepper). Friction acts at the mid-point of a step, implicitly near
/// standstill, where tanh(v / v_s) is stiff; a reversal inside a step is located. A delayed or filtered
/// command changes from step to step.
#include <memory>
#include <span>
#include <vector>

#include "crane/diagnosis/accuracy.hpp"
#include "crane/diagnosis/data.hpp"
#include "crane/diagnosis/kinematics.hpp"
#include "crane/plant/model.hpp"

namespace crane::diagnosis {

enum class Part { whole, drive, load };
inline constexpr std::array kParts{Part::whole, Part::drive, Part::load};
[[nodiscard]] const char* name_of(Part part);

/// The simulated crane.
struct Crane {
  plant::Parameters parameters;
  std::vector<plant::TermSetting> terms;
};

/// A run with the signals that all its simulations share.
struct PreparedRun {
  Run run;
  configuration::RigKind kind = configuration::RigKind::tower;
  std::array<Motion, kOutputs> motion;  ///< smoothed, by row of the grid; empty without a measurement
  /// Measured positions interpolated to the grid, for starts and prescribed motion. The predictions are
  /// compared with `run.measured`, at its own times.
  std::array<std::vector<double>, kOutputs> on_grid;
  Motion cable;
  double rig_cable_m = 0;  ///< cable length of the rig file at the start; 0: unknown
  /// `motion` in the middle of each step: [0] without, [1] with inner coordinates.
  std::array<std::vector<MeasuredKinematics>, 2> mid_step;
  std::array<double, kOutputs> least_noise{};  ///< quantisation noise, standard deviation, m or rad
  /// [trolley, slew][row]: standard deviation of the change of the speed error, m/s or rad/s. The time at
  /// which the command acts is inaccurate. Empty: the time is exact.
  std::array<std::vector<double>, 2> speed_inaccuracy;
};
/// @param accuracy of the rig file; by default it is exact
[[nodiscard]] PreparedRun prepare(Run run, const configuration::Rig& rig, const Accuracy& accuracy = {});

/// Half width of the Savitzky-Golay filter, in samples: 30 ms, at least 3 samples.
[[nodiscard]] int smoothing_half_width(double period_s);

/// Kinematics of a measured position: of a drive by a spline, of a swing by a Savitzky-Golay filter.
[[nodiscard]] Motion motion_of(Output output, const std::vector<double>& measured, double period_s);
/// Measured values at the grid's times: unchanged on a regular grid, else of a spline through them.
[[nodiscard]] std::vector<double> measured_on_grid(const Run& run, Output output);

/// Outputs that a part simulates, in the order of Output. A drive without a command is prescribed.
[[nodiscard]] std::vector<Output> simulated_outputs(const PreparedRun& run, Part part);

/// One crane on one run. The constructor filters the command of the whole run, inverts the crane's sensor
/// terms on the measured motion, and simulates inner coordinates along that motion.
class Replay {
 public:
  /// @param run outlives the replay
  Replay(const PreparedRun& run, const Crane& crane);
  ~Replay();
  Replay(Replay&&) noexcept;

  /// Size of the start of a window: position and rate of each simulated output, then of each inner coordinate
  /// that oscillates freely. Other inner coordinates start where the simulation along the measured motion
  /// has them; the load simulation prescribes them from there.
  [[nodiscard]] std::size_t start_size(Part part) const;
  /// Rms along the measured motion of the inner coordinates that oscillate freely: position and rate of each.
  [[nodiscard]] std::vector<double> inner_start_scale() const;
  /// Measured start at row `first`; its size is start_size(part).
  [[nodiscard]] std::vector<double> measured_start(Part part, std::size_t first) const;
  /// Simulates rows first ... first + rows - 1 from `start` at the grid's row `first`.
  /// @param out outputs one after the other, each row at its own time
  /// @param start as long as start_size(part), or without the inner coordinates
  /// @param end receives the state at the grid's last row, in the form of `start`
  /// @pre first + rows <= rows of the run; sizes fit
  void run(Part part, std::size_t first, std::size_t rows, std::span<const double> start,
           std::span<double> out, std::vector<double>* end = nullptr) const;
  /// The model's motion of a drive from each row to the next, evaluated along the measured motion.
  struct Increments {
    std::vector<double> position;      ///< measured, sensor terms inverted, m or rad
    std::vector<double> speed_change;  ///< m/s or rad/s
    std::vector<double> distance;      ///< from rest, m or rad

    void add_step(std::size_t row, double acceleration, double step_s) {
      distance[row] += step_s * (speed_change[row] + 0.5 * step_s * acceleration);
      speed_change[row] += step_s * acceleration;
    }
  };
  /// @pre the axis is measured
  [[nodiscard]] const Increments& increments_along_measurement(Output axis) const;

 private:
  struct CraneOnRun;
  struct RowTimeOutputs;
  std::unique_ptr<CraneOnRun> crane_on_run_;
};

using Runs = std::vector<PreparedRun>;
/// Quantisation noise of the run with the coarsest sensor, standard deviation, m or rad.
[[nodiscard]] double least_noise_of(const Runs& runs, Output output);
using Replays = std::vector<Replay>;
/// The crane on every run. @param runs outlive the replays
[[nodiscard]] Replays replays_of(const Runs& runs, const Crane& crane);

}  // namespace crane::diagnosis
