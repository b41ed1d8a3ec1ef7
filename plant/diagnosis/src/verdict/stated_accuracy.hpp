#pragma once
/// Effects and patterns within the stated accuracy of the rig file.
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "crane/diagnosis/accuracy.hpp"
#include "force/unexplained.hpp"
#include "study/known_friction.hpp"
#include "study/study.hpp"
#include "verdict/drive_error.hpp"

namespace crane::diagnosis {

class StatedAccuracy {
 public:
  StatedAccuracy(const configuration::Rig& rig, const Accuracy& accuracy);

  /// By effect: whether the effect is within the accuracy of the rig file.
  ///
  /// If the accuracy of its quantity is stated: all values of the effect are less than deviations_beyond()
  /// standard deviations from the accuracy. The errors of a scale and of a confounded quantity add.
  ///
  /// Otherwise, one of
  /// - the effect changes the simulation of no output more than the largest stated inaccuracy of a drive, a
  ///   position or the swing scale changes the simulation of the rig file;
  /// - the effect is a swing offset of at most half a resolution of the sensor.
  ///
  /// A change is an rms over the windows of one run, in each run of training and test; for a swing also over
  /// whole training runs, from the same starts; for a drive also the rms of its acceleration along the
  /// measured motion, because the position hides a force that alternates quickly. A change that the
  /// resolution of the sensor hides does not count.
  /// @param fitted with interval_std_dev
  [[nodiscard]] std::vector<bool> contains_each(const Study& study, const Fitted& fitted) const;
  /// Whether the acceleration of a pattern of a drive is within the stated accuracy of its friction.
  [[nodiscard]] bool contains(const Unexplained& pattern) const;
  /// Share of a swing that is within the accuracy: the errors of two scales, of the swing and of the position
  /// of the support, add.
  [[nodiscard]] double permitted_share_of_swing() const { return 2 * permitted_share(accuracy_); }
  /// significant_drive_error() with this accuracy.
  [[nodiscard]] std::optional<SignificantDriveError> drive_error_beyond(const WhitenedData& data,
                                                                        const Crane& crane) const;

  /// Whether the accuracy of the quantity that the effect changes is stated.
  [[nodiscard]] bool is_stated(const Candidate& candidate) const { return !limits_of(candidate).empty(); }

 private:
  /// Stated accuracy of the leading parameters; empty if its quantity has none.
  [[nodiscard]] std::vector<double> limits_of(const Candidate& candidate) const;
  /// Number of standard deviations at which one of the candidates with a stated accuracy is beyond its
  /// accuracy with the probability kFamilywiseLevel if all are within it (Bonferroni): the effects to judge
  /// are the best of these candidates.
  [[nodiscard]] double deviations_beyond(const Study& study) const;
  /// @pre the quantity of the effect has a stated accuracy
  /// @param std_dev of its values @param deviations from deviations_beyond()
  [[nodiscard]] bool contains_values(const Effect& effect, std::span<const double> std_dev,
                                     double deviations) const;
  /// By effect: whether it changes no run more than a stated inaccuracy changes it.
  [[nodiscard]] std::vector<bool> changes_little(const Study& study, const Fitted& fitted) const;
  /// Cranes whose rig file is wrong by one stated inaccuracy each.
  [[nodiscard]] std::vector<Crane> inaccurate_cranes(const Study& study, const Crane& crane) const;

  const configuration::Rig& rig_;
  Accuracy accuracy_;
  std::array<KnownFriction, 2> friction_;  ///< trolley, slew
};

}  // namespace crane::diagnosis
