#pragma once
/// What all hypotheses of a diagnosis have in common: the data, the crane of the rig file, the candidates.
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/diagnosis/accuracy.hpp"
#include "crane/diagnosis/candidate.hpp"
#include "study/body.hpp"

namespace crane::diagnosis {

/// Immutable.
class Study {
 public:
  /// @param train, test outlive the study
  /// @param excluded causes that are not candidates @param accuracy of the rig file; by default it is exact
  Study(const configuration::Rig& rig, const Runs& train, const Runs& test,
        const std::vector<std::string>& excluded = {}, const Accuracy& accuracy = {});
  Study(const configuration::Rig& rig, const Runs& train, Runs&& test,
        const std::vector<std::string>& excluded = {}, const Accuracy& accuracy = {}) = delete;
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }
  [[nodiscard]] const Crane& base() const { return base_; }              ///< of the rig file
  [[nodiscard]] double natural_radps() const { return natural_radps_; }  ///< of the load, rad/s

  [[nodiscard]] const Body& train() const { return train_; }               ///< without whitening
  [[nodiscard]] const Body& test() const { return test_; }                 ///< without whitening
  [[nodiscard]] const Problem& whole_runs() const { return whole_runs_; }  ///< of the load, training

  /// Inaccuracies of the rig file with the values of an exact one.
  [[nodiscard]] const Effects& no_inaccuracies() const { return no_inaccuracies_; }
  /// The crane of the rig file with the inaccuracies that are beside() the effects, and the effects.
  [[nodiscard]] Crane crane(const Effects& inaccuracies, const Effects& effects) const;
  /// Standard deviation of the unknown zero of a swing sensor: it is somewhere within one resolution.
  [[nodiscard]] double zero_std_dev(Output swing) const;

 private:
  double natural_radps_;
  Crane base_;
  std::vector<Candidate> candidates_, inaccurate_;
  Effects no_inaccuracies_;
  Body train_, test_;
  Problem whole_runs_;
};

/// The inaccuracies except those whose cause and axis an effect has: the effect replaces them.
[[nodiscard]] Effects beside(const Effects& inaccuracies, const Effects& effects);
/// The same without those that have the values of an exact rig file.
[[nodiscard]] Effects calibration_beside(const Effects& inaccuracies, const Effects& effects);
/// The inaccuracies beside() the effects that are visible in the same parts of the data as one of them; all
/// if there are no effects.
[[nodiscard]] Effects visible_beside(const Effects& inaccuracies, const Effects& effects);

}  // namespace crane::diagnosis
