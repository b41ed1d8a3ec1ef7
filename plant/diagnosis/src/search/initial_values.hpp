#pragma once
/// Initial values from which a hypothesis is fitted.
#include <cstdint>
#include <map>
#include <vector>

#include "study/score.hpp"

namespace crane::diagnosis {

/// Compares initial values by the loss of the training data before any fit. Remembers the best initial values
/// of each ringing cause, because their comparison needs a fit of the starts of all windows. The data are
/// always in the noise of the given hypothesis.
class InitialValues {
 public:
  /// The effects of `given` and the candidate of `score` with its best initial values.
  [[nodiscard]] Effects of(const WhitenedData& data, const Fitted& given, const Score& score);

  /// For each significant line in the residual of the swing of `given`: adds initial values to the scores of
  /// the candidates that can oscillate at this line. @param seed of the test for lines @return these
  /// candidates
  [[nodiscard]] std::vector<const Candidate*> add_of_lines(const WhitenedData& data, const Fitted& given,
                                                           std::uint64_t seed, ScoreTable& scores) const;

  /// The effects with new initial values of each force that depends on the position of an axis whose sensor
  /// another effect changes: this effect changes the positions at which the force acts.
  /// @param near fit of some of the effects
  [[nodiscard]] Effects with_new_wave(const WhitenedData& data, const Effects& effects,
                                      const Fitted& near) const;

 private:
  /// Compared initial values of a ringing cause.
  struct Ringing {
    std::vector<double> best;
    std::vector<std::vector<double>> all;
  };

  std::map<const Candidate*, Ringing> best_ringing_;
};

}  // namespace crane::diagnosis
