#pragma once
/// Spectrum of the measured swing.
#include <array>
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// Frequencies [Hz] of the strongest lines of both swing angles, strongest first: peaks of the Welch
/// periodogram (P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70) of windows of up to 12 s; lines
/// nearer to each other than 4 divided by the window's length are one. Lines below a hundredth of the
/// strongest amplitude do not count.
/// @return at most `count`; fewer where the spectrum has fewer peaks, none without a measured swing
[[nodiscard]] std::vector<double> swing_lines(const std::vector<PreparedRun>& runs, std::size_t count);

/// Setting of `double_pendulum`: share of the lower mass, length of the lower cable [m], of the upper one
/// [m].
struct TwoCables {
  double lower_share, lower_m, upper_m;
};
/// Two cables with the natural frequencies `slow_hz` < `fast_hz` of small swings. The lower share is at most
/// that of two cables of one length.
/// @param share_of_most lower share, of the largest one, 0 to 1
/// @return with the longer cable below, and with the longer cable above
[[nodiscard]] std::array<TwoCables, 2> cables_with(double slow_hz, double fast_hz, double share_of_most,
                                                   double gravity_mps2);

}  // namespace crane::diagnosis
