#pragma once
/// What a replay has ready: one crane on one run, its commands by step, its motion as its sensors would have
/// measured it, where its terms' own coordinates are along that motion.
#include <optional>

#include "crane/diagnosis/course.hpp"
#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// Half of the values so far, the last few hundred rather, are smaller.
class RunningMedian {
 public:
  void take(double value) { median_ *= value > median_ ? 1 + kShare : 1 - kShare; }
  [[nodiscard]] double value() const { return median_; }

 private:
  static constexpr double kShare = 0.02;
  double median_ = 0.02;  // m/s or rad/s, more than noise makes
};

struct Replay::Parts {
  Parts(const PreparedRun& prepared, const Crane& the_crane);

  /// Coordinates that stand still or go where they were measured while the others are simulated.
  [[nodiscard]] plant::Locks locks(const std::array<bool, kOutputs>& simulated) const;
  [[nodiscard]] double step_s() const { return source.run.period_s / steps; }
  /// Calls visit(step, voltage, whether it is another than before) for every step from a row to the next.
  template <class Visit>
  void visit_steps(std::size_t row, Visit&& visit) const {
    const auto first = row * static_cast<std::size_t>(steps);
    for (int step = 0; step < steps; ++step) {
      const auto at = first + static_cast<std::size_t>(step);
      visit(step, drive_v[at], step == 0 || drive_v[at] != drive_v[at - 1]);
    }
  }
  /// The crane as its sensors, their errors undone, have it at a row.
  [[nodiscard]] Measured measured_at(std::size_t row) const;
  /// In the middle between a row and the next; that of a step is half_way.
  [[nodiscard]] Measured measured_half_way(std::size_t row) const;
  [[nodiscard]] const Measured& half_way(std::size_t row, int step) const {
    const auto& all = sensors ? corrected_half_way : source.half_way[model.inner_coordinates() > 0 ? 1 : 0];
    return all[row * static_cast<std::size_t>(steps) + static_cast<std::size_t>(step)];
  }
  /// Measures what was measured before a row, as far back as sensors remember.
  void give_past(plant::Model& sensing, std::size_t row) const;
  [[nodiscard]] const Motion& given(Output output) const {
    return sensors ? corrected[output] : source.motion[output];
  }

  const PreparedRun& source;
  Crane crane;
  int steps;                   ///< from a row to the next
  mutable plant::Model model;  // friction and forces only; its memory is not used after construction
  bool sensors;
  std::vector<std::size_t> ringing;           ///< inner coordinates that have a start of their own
  std::array<bool, plant::kMostInner> led{};  ///< the other ones
  std::vector<plant::PerAxis> drive_v;        ///< by step
  std::array<Motion, kOutputs> corrected;
  std::vector<Measured> corrected_half_way;
  std::vector<plant::InnerState> inner_at;      ///< along the measured motion, by row; empty without any
  std::array<Motion, plant::kMostInner> inner;  ///< the same of those that are led
  std::array<std::optional<Guided>, 2> guided;  ///< drives beside led coordinates

 private:
  void undo_sensors();
  void follow_inner();
  [[nodiscard]] plant::PerAxis impacts_after(std::size_t row, std::array<RunningMedian, 2>& usual) const;
};

}  // namespace crane::diagnosis
