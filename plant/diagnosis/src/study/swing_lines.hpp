#pragma once
/// Natural frequencies of the measured swing, and the cables that have them.
#include <array>
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// Frequencies [Hz] of the strongest lines of both swing angles, strongest first: peaks of the Welch
/// periodogram (P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70) between 0.15 and 6 Hz, with
/// windows of up to 12 s. If two peaks are nearer to each other than 4 / (length of the window), only the
/// stronger one is a line. A line has at least a hundredth of the strongest line's amplitude.
/// @return at most `count` lines; fewer when the spectrum has fewer peaks, none without a measured swing
[[nodiscard]] std::vector<double> swing_lines(const std::vector<PreparedRun>& runs, std::size_t count);

/// Parameters of the term `double_pendulum`.
struct TwoCables {
  double lower_share;  ///< lower mass / total mass
  double lower_m;      ///< length of the lower cable
  double upper_m;      ///< length of the upper cable
};
/// Two cables whose small swings have the natural frequencies `slow_hz` < `fast_hz`. These frequencies permit
/// every lower share up to a largest value, at which both cables have the same length.
/// @param share_of_most lower share / largest lower share, 0 to 1
/// @return two solutions: the longer cable below, and the longer cable above
[[nodiscard]] std::array<TwoCables, 2> cables_with(double slow_hz, double fast_hz, double share_of_most,
                                                   double gravity_mps2);

}  // namespace crane::diagnosis
