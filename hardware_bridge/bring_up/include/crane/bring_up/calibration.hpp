#pragma once
/// Determines signs, scales and the position of a rig with the help of an observer. Each drive makes a small
/// motion; the observer answers in which direction and how far the axis has moved. The result is a rig file
/// that extends the original one.
#include <array>
#include <filesystem>
#include <functional>
#include <string>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

/// Largest swing that counts as rest: about eight counts of the encoders of the Virginia Tech rig.
/// Incremental swing encoders have their zero at the start of the session; a swing at this time becomes an
/// offset.
inline constexpr double kSettled_rad = 2e-3;

struct CalibrationOptions {
  double largest_v = 4;  ///< largest voltage of a push; pushes begin at 1 V; in (0, kLargestJog_v]
  std::array<double, kDrives> distance{0.1, 0.3, 0.1};  ///< motion of each drive: m, rad, m
  /// Asks a question and waits for the answer. @throws Ended at the end of input
  std::function<std::string(const std::string& question)> ask;
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

struct Calibration {
  std::array<int, kDrives> drive_sign{1, 1, 1};
  std::array<int, kCounters> encoder_sign{1, 1, 1, 1, 1};
  std::array<double, kCounters> counts_per_unit{};
  std::array<double, kDrives> position{};  ///< present position: m, rad, m of cable
};

/// The board is at 0 V with closed brakes during every question and at the end.
/// @throws Ended, also when the load does not come to rest; std::runtime_error when a brake does
///   not hold, an encoder does not follow, or an axis reaches a limit switch
[[nodiscard]] Calibration calibrate(Session& session, const CalibrationOptions& options);

/// @return text of a rig file for the path `file`, which extends the file of `rig` by the calibrated values
/// @throws configuration::ConfigurationError when the result has problems, or when `file` is the calibration
/// of another rig, is not a rig file, or is the rig file itself
[[nodiscard]] std::string calibration_file(const configuration::Rig& rig, const Calibration& calibration,
                                           const std::filesystem::path& file);
/// Checks before a calibration that `file` may be written for `rig`.
/// @throws configuration::ConfigurationError
void require_own_file(const configuration::Rig& rig, const std::filesystem::path& file);

}  // namespace crane::bring_up
