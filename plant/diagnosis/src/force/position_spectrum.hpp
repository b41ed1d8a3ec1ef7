#pragma once
/// Spectrum over position of the unexplained force on a drive.
#include <vector>

#include "shooting/pieces.hpp"

namespace crane::diagnosis {

/// force: along the axis, a function of the position only. friction: multiplied by the sign of the speed.
enum class WaveOf { force, friction };

/// amplitude * sin(2 pi position / period + phase_rad), in m/s2 or rad/s2, with the sign of the speed for a
/// friction.
struct PositionWave {
  double period = 0, amplitude = 0, phase_rad = 0;
};

/// Peaks of the spectrum, strongest first.
/// @param drive pieces of a drive
[[nodiscard]] std::vector<PositionWave> strongest_waves(const Pieces& drive, std::size_t count,
                                                        WaveOf of = WaveOf::force);

}  // namespace crane::diagnosis
