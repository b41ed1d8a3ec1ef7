#pragma once
/// What may be named: terms of plant/model by the same names, each with the parameters that it frees, where
/// fits begin, and how its values are said in a rig file.
#include <functional>

#include "crane/plant/parameters.hpp"
#include "fit/ascent.hpp"

namespace crane::innovations {

struct Estimate {
  std::string name, unit;
  double value = 0, std_dev = 0;
};

struct Candidate {
  std::string name, axis;
  std::vector<Index> theta;
  /// Fits begin at these values of theta, too, besides a step of the score.
  std::vector<std::vector<double>> starts;
  /// Starts are tried with the unknown force at a quarter: an effect and a large unknown force are two
  /// valleys.
  bool quiet_starts = false;
  bool known_parameter = false;       ///< the rig file has this quantity
  bool term = true;                   ///< plant/model has a term of this name
  std::vector<std::size_t> channels;  ///< that it acts on

  [[nodiscard]] std::string label() const { return axis.empty() ? name : name + " (" + axis + ")"; }
};

/// All that the rig and the data can have.
[[nodiscard]] std::vector<Candidate> candidates_for(const Problem& problem);

/// Parameters of the term beyond the base's, as the rig file says them.
[[nodiscard]] plant::TermSetting setting_of(const Candidate& candidate, const Problem& problem,
                                            const Values& values);
/// The same with standard deviations by the delta method. @param covariance of theta
[[nodiscard]] std::vector<Estimate> estimates_of(const Candidate& candidate, const Problem& problem,
                                                 const Values& values, const Eigen::MatrixXd& covariance);

}  // namespace crane::innovations
