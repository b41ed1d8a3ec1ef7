#pragma once
/// Integration of plant::Model over one span of constant command, SUNDIALS CVODE (BDF, variable order and
/// step).
///
/// Every span starts afresh at order 1: the command jumps there, so the history of the last span describes
/// another right-hand side. The result depends on the arguments only, not on earlier calls: same input, same
/// bits. Friction is smooth (tanh of speed over the terms' smoothing speed), which makes the equations stiff
/// near standstill and never discontinuous inside a span.
#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "crane/plant/model.hpp"

namespace crane::simulator {

/// Local error per step: |error| <= relative |y| + absolute for positions in m or rad and speeds per second.
/// With the defaults a 10 s maneuver with friction is right to 1e-5 in every coordinate and speed, measured
/// against a fixed-step Runge-Kutta of 20 us; a tenth of the tolerances gives 1e-6.
struct Tolerances {
  double relative = 1e-8;
  double absolute = 1e-8;
};

/// Where integration has to stop early.
struct Watch {
  std::array<bool, plant::kAxes> standstill{};                            ///< when the axis's speed crosses 0
  plant::PerAxis low = filled(-std::numeric_limits<double>::infinity());  ///< when the position falls to this
  plant::PerAxis high = filled(std::numeric_limits<double>::infinity());  ///< when the position rises to this

  [[nodiscard]] bool active() const;

 private:
  static constexpr plant::PerAxis filled(double value) { return {value, value, value}; }
};

enum class EventKind { standstill, low, high };
struct Event {
  EventKind kind = EventKind::standstill;
  plant::Axis axis = plant::kTrolley;
};

struct Advance {
  double elapsed_s = 0;        ///< the whole span, or the time of the event
  std::optional<Event> event;  ///< the first one
};

class Integrator {
 public:
  /// The model has to outlive the integrator. @throws std::runtime_error when CVODE cannot be set up
  explicit Integrator(const plant::Model& model, const Tolerances& tolerances = {});
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  ~Integrator();

  /// Moves `state` and the structure terms' own coordinates on by `span_s` or to the first event.
  /// @pre span_s > 0; locked coordinates have rate 0
  /// @throws std::runtime_error when the step size collapses (theta at 90 degrees, cable length 0)
  Advance advance(plant::State& state, plant::InnerState& inner, const plant::Actuation& actuation,
                  double span_s, const Watch& watch = {});
  /// The same for a model without coordinates of structure terms, or with them starting at rest.
  Advance advance(plant::State& state, const plant::Actuation& actuation, double span_s,
                  const Watch& watch = {});

  /// Evaluations of the equations of motion since construction, those for the Jacobian included.
  [[nodiscard]] long evaluations() const noexcept;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace crane::simulator
