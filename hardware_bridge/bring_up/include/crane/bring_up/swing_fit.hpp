#pragma once
/// What a swing encoder tells while trolley and jib stand still: the load is a pendulum of known frequency,
/// so that angle(t) = offset + cosine cos(wt) + sine sin(wt), w = sqrt(g / L). Pure functions.
#include <cstddef>
#include <span>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

struct SwingFit {
  double offset_rad = 0;  ///< where the load would come to rest
  double cosine_rad = 0, sine_rad = 0;

  [[nodiscard]] double amplitude_rad() const;
  [[nodiscard]] double at(double time_s, double frequency_radps) const;
};

/// sqrt(g / L) of the rig at its start.
[[nodiscard]] double swing_frequency_radps(const configuration::Rig& rig);

/// Least squares over a record that lasts at least half a period.
/// @param counter  3 radial, 4 tangential
[[nodiscard]] SwingFit fit_swing(std::span<const Sample> record, std::size_t counter, double frequency_radps);

/// The swing that a motion of the load's suspension leaves: the load stays behind by the displacement of each
/// tick and swings freely from then on; displacements far below the cable's length.
/// @param lever_m_per_unit  displacement of the suspension in the swing's positive sense per unit of the axis
[[nodiscard]] SwingFit expected_swing(std::span<const Sample> motion, std::size_t axis,
                                      double lever_m_per_unit, double cable_m, double frequency_radps);

/// How much of `expected` has been added between `before` and `after`: 1 all, -1 the opposite, 0 nothing.
[[nodiscard]] double share_of(const SwingFit& expected, const SwingFit& before, const SwingFit& after);

}  // namespace crane::bring_up
