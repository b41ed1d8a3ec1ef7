#pragma once
/// Errors of a swing that are not random: functions of the motion, or of one frequency. The noise model
/// (docs/diagnosis_method.md, 4) absorbs also a force that follows from the motion.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shooting/problem.hpp"

namespace crane::diagnosis {

/// Part of the residual of a swing.
struct SwingPattern {
  std::string name;  ///< "swing_radial_rad: force, position of the trolley"
  Output output = kRadialSwing;
  double fraction = 0;  ///< of the loss of the output
  double rms_rad = 0;   ///< in windows, beside the free motion of the load
  /// True for a function of the swing or of its rate: `rms_rad` is also beside errors of scales, cable length
  /// and delay.
  bool of_own_swing = false;
};

/// Patterns of one output, the largest gain first: a force on the load, or an error of the swing sensor, that
/// is a function of position, speed, swing, rate of the swing, or time. The function has one amplitude for
/// each triangular bin of its variable. The cross-validated decrease of the loss exceeds kPatternLuck, and
/// the decreases by all patterns in 99 copies of the residual whose blocks of kBlock_s have random signs.
/// @param problem of the load, whitened, with windows of several periods
/// @param output index into its outputs @param seed of the signs
[[nodiscard]] std::vector<SwingPattern> find_swing_patterns(const Problem& problem, const Fits& fits,
                                                            std::size_t output, std::uint64_t seed);

/// Force in a narrow band of frequencies, with another phase in each window: the spectrum of the whitened
/// residual has a maximum that exceeds the spectrum at half and at twice the frequency. The whitened residual
/// of a random force has a flat spectrum; with an imprecise noise model, a monotonic one. Level kSignificant
/// (F test, Bonferroni over the frequencies that a window resolves).
[[nodiscard]] std::optional<SwingPattern> find_narrow_band(const Problem& problem, const Fits& fits,
                                                           std::size_t output);

}  // namespace crane::diagnosis
