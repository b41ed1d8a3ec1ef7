#pragma once
/// The training data in the noise of one hypothesis.
#include "study/blocks.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// Training data whitened with one noise model, with the fitted inaccuracies of the rig file. Immutable.
class WhitenedData {
 public:
  /// @param study outlives this object
  WhitenedData(const Study& study, Nuisance nuisance);

  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] const Nuisance& nuisance() const { return nuisance_; }
  [[nodiscard]] const Runs& runs() const { return body_.runs; }
  [[nodiscard]] const Body& body() const { return body_; }
  [[nodiscard]] const Problem& drive() const { return body_.drive; }
  [[nodiscard]] const Problem& load() const { return body_.load; }

  /// The crane of the rig file with the inaccuracies and these effects. The effects replace the inaccuracies
  /// of the same cause.
  [[nodiscard]] Crane with(const Effects& effects) const;

  /// Evaluation of the crane of the rig file with the inaccuracies.
  [[nodiscard]] Evaluation base() const;
  /// Simulates only the parts in which `effects` are visible; copies the others.
  /// @param near  evaluation of some of the effects; gives the initial starts of the windows
  [[nodiscard]] Evaluation evaluated(const Effects& effects, const Evaluation& near) const;
  /// Evaluation of a fit that was evaluated in another noise.
  [[nodiscard]] Evaluation evaluated_again(const Fitted& fitted) const;

  /// Plain slopes along the values of the effects. @param known  as far as known: of the leading values, in
  /// the parts that are not empty
  [[nodiscard]] Slopes plain_slopes(const Effects& effects, const Evaluation& at, Slopes known = {}) const;
  /// Plain slope of a crane that differs from that of `at` by `step`. @param unmoved plain residuals of the
  /// equation error of `at`; used if the drive is among the parts
  [[nodiscard]] PlainSlope plain_slope(const Replays& crane, const Evaluation& at, double step, ShowsIn parts,
                                       const PartVectors& unmoved) const;
  [[nodiscard]] Slopes whitened(const Slopes& plain, const Evaluation& at) const;
  /// Scores of directions around `at`. @param slopes whitened
  [[nodiscard]] BlockScores scores(const Evaluation& at, const Slopes& slopes,
                                   Loss loss = Loss::robust) const;

 private:
  const Study& study_;
  Nuisance nuisance_;
  Body body_;
};

/// Step of the finite difference of a slope, with its sign: the parameter stays within its bounds.
[[nodiscard]] double difference_step(const FreeParameter& p, double value);

}  // namespace crane::diagnosis
