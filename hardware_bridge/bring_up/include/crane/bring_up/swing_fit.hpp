#pragma once
/// Fits the swing while trolley and jib are at rest. The load is a pendulum of known frequency:
/// angle(t) = offset + cosine cos(wt) + sine sin(wt), w = sqrt(g / L). Pure functions.
#include <cstddef>
#include <span>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

struct SwingFit {
  double offset_rad = 0;  ///< angle of the load at rest
  double cosine_rad = 0, sine_rad = 0;

  [[nodiscard]] double amplitude_rad() const;
  [[nodiscard]] double at(double time_s, double frequency_radps) const;
};

/// sqrt(g / L) with the cable length in [start] of the rig file.
[[nodiscard]] double swing_frequency_radps(const configuration::Rig& rig);

/// Least-squares fit. @pre the record has at least half a period
/// @param counter  3 radial, 4 tangential
[[nodiscard]] SwingFit fit_swing(std::span<const Sample> record, std::size_t counter, double frequency_radps);

/// Swing after a motion of the suspension point that is short compared with the cable. In each tick the load
/// lags behind by the displacement, then swings freely.
/// @param lever_m_per_unit  displacement of the suspension point in the positive direction of the swing, per
///   unit of the axis
[[nodiscard]] SwingFit expected_swing(std::span<const Sample> motion, std::size_t axis,
                                      double lever_m_per_unit, double cable_m, double frequency_radps);

/// Share of `expected` in the change from `before` to `after`: 1: all, 0: nothing, -1: the opposite.
[[nodiscard]] double share_of(const SwingFit& expected, const SwingFit& before, const SwingFit& after);

}  // namespace crane::bring_up
