#pragma once
/// Signs, scales and the place of a rig, found with somebody who stands beside it: each drive moves a little,
/// the observer says which way and how far. The result is a rig file that extends the one it began with.
#include <array>
#include <filesystem>
#include <functional>
#include <string>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

/// A load that swings no more hangs still: half a dozen counts of the tower's encoders. Incremental swing
/// encoders have their zero where the load hangs at the start, so what it swings then becomes an offset.
inline constexpr double kSettled_rad = 2e-3;

struct CalibrationOptions {
  double largest_v = 4;                                 ///< pushes grow from 1 V to this, (0, kLargestJog_v]
  std::array<double, kDrives> distance{0.1, 0.3, 0.1};  ///< m, rad, m
  /// Asks and waits for a line. @throws Ended when there is nobody to answer
  std::function<std::string(const std::string& question)> ask;
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

struct Calibration {
  std::array<int, kDrives> drive_sign{1, 1, 1};
  std::array<int, kCounters> encoder_sign{1, 1, 1, 1, 1};
  std::array<double, kCounters> counts_per_unit{};
  std::array<double, kDrives> position{};  ///< where the crane stands now: m, rad, m of cable
};

/// Board at 0 V with closed brakes during every question and at the end.
/// @throws Ended; std::runtime_error when a brake does not hold, an encoder does not follow, or the load
///   does not come to rest
[[nodiscard]] Calibration calibrate(Session& session, const CalibrationOptions& options);

/// Rig file at `file` that extends that of `rig`, with the values of the calibration.
/// @throws configuration::ConfigurationError when it would not be a usable rig, `file` is the calibration of
///   another rig, no rig file, or the rig file itself
[[nodiscard]] std::string calibration_file(const configuration::Rig& rig, const Calibration& calibration,
                                           const std::filesystem::path& file);
/// The same check without a calibration: may `file` be written for `rig`? @throws
/// configuration::ConfigurationError
void require_own_file(const configuration::Rig& rig, const std::filesystem::path& file);

}  // namespace crane::bring_up
