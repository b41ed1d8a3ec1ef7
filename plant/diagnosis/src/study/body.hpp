#pragma once
/// Runs with their residuals: windows of the drives, equation error of the drives, windows of the load.
#include <vector>

#include "shooting/equation_error.hpp"
#include "shooting/problem.hpp"
#include "study/hypothesis.hpp"
#include "study/slopes.hpp"

namespace crane::diagnosis {

/// Immutable; the runs outlive it.
class Body {
 public:
  /// Without whitening. @param natural_radps of the load, rad/s
  Body(const Runs& all, double natural_radps);
  /// Whitened with noise and disturbance of the residuals of a crane.
  Body(const Body& plain, const Replays& crane);
  /// Whitened with these nuisance parameters. @param crane  any crane on these runs
  Body(const Body& plain, const Nuisance& nuisance, const Replays& crane);
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  const Runs& runs;
  const Problem drive, load;
  const EquationError equation_error;
};

/// Evaluation of a crane: the starts of all windows are estimated from the measured starts.
[[nodiscard]] Evaluation evaluated(const Body& body, const Replays& crane);
/// The same in another noise, from the starts of `near`.
[[nodiscard]] Evaluation evaluated_again(const Body& body, const Replays& crane, const Evaluation& near);
/// Evaluation of a crane that is similar to that of `near`, from its starts. Other parts than `parts` are
/// copied from `near`.
[[nodiscard]] Evaluation evaluated_near(const Body& body, const Replays& crane, ShowsIn parts,
                                        const Evaluation& near);

/// Simulated outputs of an evaluation by window, not whitened.
struct Simulation {
  PartVectors drive, load;
};
[[nodiscard]] Simulation simulation_of(const Evaluation& at);
/// Parts in which the simulation with the effects differs from another one by more than a fifth of the
/// motion. In the other parts, a slope of the other simulation is nearly that of the hypothesis.
/// @param other empty: unlike in all parts in which the effects are visible
[[nodiscard]] ShowsIn unlike(const Body& body, const Effects& effects, const Evaluation& at,
                             const Simulation& other);

/// Noise and disturbance of the residuals of one crane.
[[nodiscard]] Nuisance noise_of(const Body& body, const Evaluation& at, const Replays& crane);
/// Minus twice the log likelihood by block. @pre the body is whitened
[[nodiscard]] Blocks deviance_of(const Body& body, const Evaluation& at);

}  // namespace crane::diagnosis
