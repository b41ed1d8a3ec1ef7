#pragma once
/// Pairs of causes of one drive, found in the equation error.
#include <vector>

#include "study/probe_slopes.hpp"
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// The pairs of candidates of one axis that describe the equation error best, with their values. A search by
/// single effects misses a pair whose effects partly cancel, for example a lower Coulomb friction beside a
/// Stribeck friction: neither of them alone improves the simulation. The equation error is linear in the
/// missing force and does not depend on the times of stick and slip. A linear regression therefore compares
/// all pairs without a simulation; the values of the best ones are then fitted to the equation error alone.
/// @param base  evaluation of the base model
/// @param known  slopes of the probes of the base model
/// @return at most `count`, in the order of increasing loss
[[nodiscard]] std::vector<Effects> strongest_drive_pairs(const WhitenedData& data, const Evaluation& base,
                                                         const ProbeSlopes& known, std::size_t count);

}  // namespace crane::diagnosis
