#pragma once
/// Integrates plant::Model over a span with constant command, by one of two methods:
///   cvode  SUNDIALS CVODE (BDF, variable order and step): the reference and the default
///   fast   one-step methods (fast_solver.cpp): 15 to 27 times faster (docs/benchmarks.md)
///
/// Each span is a new initial value problem. CVODE begins with order 1, because the command changes in steps
/// and the history of the previous span belongs to another right-hand side. The result depends on the
/// arguments only, not on earlier calls; equal arguments give equal bits. The friction is a smooth function
/// of the speed (tanh), so that the equations are stiff near standstill and continuous within a span.
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>

#include "crane/plant/model.hpp"

namespace crane::simulator {

enum class Method { cvode, fast };
inline constexpr std::array kMethodNames{"cvode", "fast"};
/// @pre the name is one of kMethodNames
[[nodiscard]] inline Method method_named(std::string_view name) {
  return name == kMethodNames[1] ? Method::fast : Method::cvode;
}

/// Local error per step: |error| <= relative |y| + absolute; positions in m or rad, speeds per second. With
/// the defaults, the error of every coordinate and speed in a 10 s maneuver with friction is below 1e-5,
/// compared with a Runge-Kutta method with a fixed step of 20 us. With a tenth of the tolerances it is below
/// 1e-6.
struct Tolerances {
  double relative = 1e-8;
  double absolute = 1e-8;
};

/// Events that end the integration early.
struct Watch {
  std::array<bool, plant::kAxes> standstill{};  ///< true: event when the speed of the axis crosses 0
  /// An event occurs when the position of the axis falls to `low` or rises to `high`.
  plant::PerAxis low = filled(-std::numeric_limits<double>::infinity());
  plant::PerAxis high = filled(std::numeric_limits<double>::infinity());

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
  double elapsed_s = 0;        ///< integrated time: the whole span, or the time of the event
  std::optional<Event> event;  ///< the first event; nothing: no event
  /// Suggested first step of the next span, for a similar motion. A step that is too long costs a
  /// rejected step.
  double next_first_step_s = 0;
};

class Solver;

class Integrator {
 public:
  /// `model` must outlive the integrator. @throws std::runtime_error when CVODE cannot be initialised
  explicit Integrator(const plant::Model& model, const Tolerances& tolerances = {},
                      Method method = Method::cvode);
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  ~Integrator();

  /// Advances `state` and the inner coordinates by `span_s`, or up to the first event.
  /// @param first_step_s  first step that the fast method tries, within the span; cvode ignores it
  /// @pre span_s > 0, first_step_s > 0; locked coordinates have rate 0
  /// @throws std::runtime_error when the step size becomes too small (theta at 90 degrees, cable length 0)
  Advance advance(plant::State& state, plant::InnerState& inner, const plant::Actuation& actuation,
                  double span_s, const Watch& watch = {},
                  double first_step_s = std::numeric_limits<double>::infinity());
  /// Advances a model without inner coordinates, or with inner coordinates that start at rest at 0.
  Advance advance(plant::State& state, const plant::Actuation& actuation, double span_s,
                  const Watch& watch = {});

  /// Number of evaluations of the equations of motion since construction, including those for the Jacobian.
  [[nodiscard]] long evaluations() const noexcept;

 private:
  std::unique_ptr<Solver> solver_;
};

}  // namespace crane::simulator
