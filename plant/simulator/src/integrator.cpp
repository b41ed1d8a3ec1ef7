#include "crane/simulator/integrator.hpp"

#include <algorithm>
#include <cmath>

#include "solver.hpp"

namespace crane::simulator {

bool Watch::active() const {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::find(standstill.begin(), standstill.end(), true) != standstill.end() ||
         std::any_of(low.begin(), low.end(), finite) || std::any_of(high.begin(), high.end(), finite);
}

Integrator::Integrator(const plant::Model& model, const Tolerances& tolerances, Method method)
    : solver_(method == Method::cvode ? make_cvode_solver(model, tolerances)
                                      : make_fast_solver(model, tolerances)) {}
Integrator::~Integrator() = default;

long Integrator::evaluations() const noexcept { return solver_->evaluations(); }

Advance Integrator::advance(plant::State& state, const plant::Actuation& actuation, double span_s,
                            const Watch& watch) {
  plant::InnerState inner{};
  return advance(state, inner, actuation, span_s, watch);
}

Advance Integrator::advance(plant::State& state, plant::InnerState& inner, const plant::Actuation& actuation,
                            double span_s, const Watch& watch, double first_step_s) {
  Motion motion{state, inner};
  const Advance advance = solver_->advance(motion, actuation, span_s, watch, first_step_s);
  state = motion.state;
  inner = motion.inner;
  return advance;
}

}  // namespace crane::simulator
