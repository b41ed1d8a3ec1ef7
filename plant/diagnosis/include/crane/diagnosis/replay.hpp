#pragma once
/// The measured command, and where wanted the measured motion, through the model: structured replays.
///   whole  command -> positions and swing
///   drive  command and measured swing -> positions: fails when drives or friction are wrong
///   load   measured motion -> swing: fails when the load or its sensors are wrong
///
/// Fixed steps of at most 5 ms (2.5 ms when a term has coordinates of its own), drift-kick-drift, second
/// order. Friction is taken at the mid-point of a step and implicitly around standstill, where tanh(v / v_s)
/// is stiff; a reversal inside a step is met exactly. A command that terms delay or smooth changes from step
/// to step, not from row to row.
#include <memory>
#include <span>
#include <vector>

#include "crane/diagnosis/data.hpp"
#include "crane/diagnosis/kinematics.hpp"
#include "crane/plant/model.hpp"

namespace crane::diagnosis {

enum class Part { whole, drive, load };
inline constexpr std::array kParts{Part::whole, Part::drive, Part::load};
[[nodiscard]] const char* name_of(Part part);

/// The crane that is simulated.
struct Crane {
  plant::Parameters parameters;
  std::vector<plant::TermSetting> terms;
};

/// A run with what every replay of it needs.
struct PreparedRun {
  Run run;
  configuration::RigKind kind = configuration::RigKind::tower;
  std::array<Motion, kOutputs> motion;  ///< smoothed; empty without a measurement
  /// What was measured, at the grid's times: only where a replay follows it and where a start begins. What is
  /// compared is `run.measured`, at its own times.
  std::array<std::vector<double>, kOutputs> on_grid;
  Motion cable;
  /// Along `motion`, in steps without and with coordinates of terms' own; what every replay goes by.
  std::array<std::vector<MeasuredKinematics>, 2> mid_step;
  std::array<double, kOutputs> least_noise{};  ///< what counting alone makes, m or rad
};
[[nodiscard]] PreparedRun prepare(Run run, const configuration::Rig& rig);

/// Samples over which positions are smoothed for their rates and accelerations, each way: 30 ms.
[[nodiscard]] int smoothing_half_width(double period_s);

/// A measured position with its rate and acceleration: a drive's as the spline through it, a swing's
/// smoothed.
[[nodiscard]] Motion motion_of(Output output, const std::vector<double>& measured, double period_s);
/// What a run measured at the grid's times: the values themselves where it is regular, else a spline through
/// them.
[[nodiscard]] std::vector<double> measured_on_grid(const Run& run, Output output);

/// Which outputs a part simulates on a run; the order is that of Output. A drive without a command is none of
/// them: it goes where it was measured.
[[nodiscard]] std::vector<Output> simulated_outputs(const PreparedRun& run, Part part);

/// One crane on one run: command terms have gone over the whole of it, the errors of the crane's sensors are
/// taken out of the measured motion, its terms' own coordinates have followed that motion.
class Replay {
 public:
  /// @param run outlives the replay
  Replay(const PreparedRun& run, const Crane& crane);
  ~Replay();
  Replay(Replay&&) noexcept;

  /// Numbers that start a window of a part: position and rate per simulated output, then those of the model's
  /// inner coordinates that ring on by themselves. Inner coordinates that are not prescribed_motion begin
  /// where the measured motion of the whole run has brought them, and in a replay of the load go where it
  /// brings them: what the motors' measured speed shows of impacts has corrected that.
  [[nodiscard]] std::size_t start_size(Part part) const;
  /// How far those of the inner coordinates go along the measured motion, rms over the run.
  [[nodiscard]] std::vector<double> inner_start_scale() const;
  /// What the measurement says about them at row `first`.
  [[nodiscard]] std::vector<double> measured_start(Part part, std::size_t first) const;
  /// Rows first ... first + rows - 1 from `start` at the grid's row `first`, each at its own instant; `out`
  /// takes output by output.
  /// @param start as long as start_size(part), or without the inner coordinates
  /// @pre first + rows <= rows of the run; sizes fit
  void run(Part part, std::size_t first, std::size_t rows, std::span<const double> start,
           std::span<double> out) const;
  /// A drive along the measured motion, by row: where it was, the errors of its sensor undone, and what the
  /// model's acceleration makes of speed and way until the next row.
  struct Increments {
    std::vector<double> position;      ///< m or rad
    std::vector<double> speed_change;  ///< gained, m/s or rad/s
    std::vector<double> distance;      ///< gone from rest, m or rad

    void add_step(std::size_t row, double acceleration, double step_s) {
      distance[row] += step_s * (speed_change[row] + 0.5 * step_s * acceleration);
      speed_change[row] += step_s * acceleration;
    }
  };
  /// @pre the axis is measured
  [[nodiscard]] Increments increments_along_measurement(Output axis) const;

 private:
  struct CraneOnRun;
  struct RowTimeOutputs;
  std::unique_ptr<CraneOnRun> crane_on_run_;
};

using Runs = std::vector<PreparedRun>;
using Replays = std::vector<Replay>;
/// The crane on every run. @param runs outlive the replays
[[nodiscard]] Replays replays_of(const Runs& runs, const Crane& crane);

}  // namespace crane::diagnosis
