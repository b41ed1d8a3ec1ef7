#pragma once
/// Motion of a model with structure terms, integrated with fixed steps.
#include "crane/plant/model.hpp"

namespace crane::test {

struct StructureMotion {
  plant::State state;
  plant::InnerState inner{};
};

/// The drives are at rest or have the given acceleration; only the load moves freely.
inline plant::Actuation held(const plant::PerAxis& acceleration = {}) {
  plant::Actuation actuation;
  actuation.locks.axis = {true, true, true};
  actuation.locks.acceleration = acceleration;
  return actuation;
}

/// One classical Runge-Kutta step.
inline StructureMotion step(const plant::Model& model, const StructureMotion& from,
                            const plant::Actuation& actuation, double h_s) {
  using plant::StateArray;
  struct Slope {
    StateArray state;
    plant::InnerState inner;
  };
  const auto slope = [&](const StructureMotion& m) {
    plant::InnerAccelerations own{};
    const plant::Accelerations a = model.accelerations(m.state, actuation, m.inner, own);
    const plant::State& s = m.state;
    Slope k{{s.trolley_mps, s.radial_radps, s.slew_radps, s.tangential_radps, s.cable_mps, a.trolley_mps2,
             a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2},
            {}};
    for (std::size_t i = 0; i < model.inner_coordinates(); ++i) k.inner[i] = {m.inner[i].rate, own[i]};
    return k;
  };
  const auto along = [](const StructureMotion& m, const Slope& k, double h) {
    StateArray y = plant::to_array(m.state);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h * k.state[i];
    StructureMotion moved{plant::to_state(y), m.inner};
    for (std::size_t i = 0; i < k.inner.size(); ++i) {
      moved.inner[i].position += h * k.inner[i].position;
      moved.inner[i].rate += h * k.inner[i].rate;
    }
    return moved;
  };
  const Slope k1 = slope(from), k2 = slope(along(from, k1, h_s / 2)), k3 = slope(along(from, k2, h_s / 2)),
              k4 = slope(along(from, k3, h_s));
  return along(along(along(along(from, k1, h_s / 6), k2, h_s / 3), k3, h_s / 3), k4, h_s / 6);
}

}  // namespace crane::test
