#pragma once
/// Test of "the error of a drive in windows is noise, or an error of the rig file within its accuracy".
#include <optional>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/diagnosis/accuracy.hpp"
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Error of one drive in the windows of the training data.
struct DriveError {
  Output output = kTrolleyPosition;
  std::vector<double> rms;       ///< rms residual of the crane by window, m or rad
  std::vector<double> expected;  ///< its standard uncertainty, m or rad
};

/// Errors of the drives of a crane. The starts of the windows minimise the errors. The variance of the error
/// of a window is the sum of
/// - the variance of the sensor noise as learnt;
/// - a third of the squared change of the simulation by the stated inaccuracy of each free quantity: variance
///   of a uniform distribution between the bounds (JCGM 100:2008, 4.3.7); a sixth for level and asymmetry of
///   a friction. The sum of these terms is at least its mean over all windows, because a simulation that
///   sticks does not show the uncertainty of the friction;
/// - for disturbances that grow with the motion, the square of permitted_share() times the rms motion in the
///   windows;
/// - for a random force on the drive, the variance that the learnt disturbance causes in a window whose start
///   is estimated; the disturbance is at most kCredibleDrive of the acceleration at volt_limit.
/// Windows in which an edge of the command may be lost are omitted.
[[nodiscard]] std::vector<DriveError> drive_errors(const WhitenedData& data, const Crane& crane,
                                                   const configuration::Rig& rig, const Accuracy& accuracy);

/// p value of the number of windows whose error exceeds kDriveError standard uncertainties, for a normal
/// error in each window: tail of the binomial distribution.
[[nodiscard]] double p_value(const DriveError& error);

/// The drive whose error is significant.
struct SignificantDriveError {
  Output output = kTrolleyPosition;
  std::string description;
};

/// Level kSignificant, Bonferroni over the drives.
[[nodiscard]] std::optional<SignificantDriveError> significant_drive_error(const WhitenedData& data,
                                                                           const Crane& crane,
                                                                           const configuration::Rig& rig,
                                                                           const Accuracy& accuracy);

}  // namespace crane::diagnosis
