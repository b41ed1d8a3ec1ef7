#pragma once
/// Interface of the two methods behind Integrator, and their common state vector.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "crane/simulator/integrator.hpp"

namespace crane::simulator {

/// Coordinates of the crane without inner coordinates.
inline constexpr std::size_t kRigid = plant::kStateSize / 2;

/// State vector of a solver: coordinates of the crane, inner coordinates, then the rates of all.
struct Motion {
  plant::State state;
  plant::InnerState inner{};
};

[[nodiscard]] inline Motion motion_of(const double* y, std::size_t inner) {
  plant::StateArray values{};
  const double* rates = y + kRigid + inner;
  std::copy_n(y, kRigid, values.begin());
  std::copy_n(rates, kRigid, values.begin() + kRigid);
  Motion motion{.state = plant::to_state(values)};
  for (std::size_t i = 0; i < inner; ++i)
    motion.inner[i] = {.position = y[kRigid + i], .rate = rates[kRigid + i]};
  return motion;
}

inline void store(const Motion& motion, std::size_t inner, double* y) {
  const plant::StateArray values = plant::to_array(motion.state);
  double* rates = y + kRigid + inner;
  std::copy_n(values.begin(), kRigid, y);
  std::copy_n(values.begin() + kRigid, kRigid, rates);
  for (std::size_t i = 0; i < inner; ++i) {
    y[kRigid + i] = motion.inner[i].position;
    rates[kRigid + i] = motion.inner[i].rate;
  }
}

/// Distances to the events of a Watch, per axis in the order of EventKind. An event is a change of sign; an
/// event that is not watched has the distance 1.
inline constexpr std::size_t kDistances = 3 * plant::kAxes;
inline void measure_distances(const Watch& watch, const double* y, std::size_t half, double* distance) {
  for (std::size_t axis = 0; axis < plant::kAxes; ++axis) {
    const std::size_t i = plant::kPositionIndex[axis];
    double* d = distance + 3 * axis;
    d[0] = watch.standstill[axis] ? y[i + half] : 1.0;
    d[1] = std::isfinite(watch.low[axis]) ? y[i] - watch.low[axis] : 1.0;
    d[2] = std::isfinite(watch.high[axis]) ? watch.high[axis] - y[i] : 1.0;
  }
}
[[nodiscard]] inline Event event_of(std::size_t distance) {
  return {static_cast<EventKind>(distance % 3), static_cast<plant::Axis>(distance / 3)};
}

class Solver {
 public:
  Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  virtual ~Solver() = default;
  /// @see Integrator::advance
  virtual Advance advance(Motion& motion, const plant::Actuation& actuation, double span_s,
                          const Watch& watch, double first_step_s) = 0;
  [[nodiscard]] virtual long evaluations() const noexcept = 0;
};

[[nodiscard]] std::unique_ptr<Solver> make_cvode_solver(const plant::Model& model,
                                                        const Tolerances& tolerances);
[[nodiscard]] std::unique_ptr<Solver> make_fast_solver(const plant::Model& model,
                                                       const Tolerances& tolerances);

}  // namespace crane::simulator
