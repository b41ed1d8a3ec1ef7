#pragma once
/// Maximum likelihood: BHHH ascent (Berndt, Hall, Hall, Hausman, Ann. Econ. Soc. Meas. 3 (1974) 653) with
/// Levenberg-Marquardt damping, bounds, and steps that are stretched while they help.
#include "likelihood/problem.hpp"

namespace crane::innovations {

struct Fit {
  Hypothesis at;
  double value = -1e300;         ///< log likelihood and prior
  std::vector<double> by_value;  ///< log likelihoods
  [[nodiscard]] bool usable() const { return !by_value.empty(); }
};

struct AscentLimits {
  int rounds = 8;
  double least_gain = 0.3;  ///< nats of a round; less ends it
};

[[nodiscard]] Fit ascend(const Problem& problem, Hypothesis from, const std::vector<Index>& free,
                         AscentLimits limits);

/// Starts of the lower cable, run by run, by Gauss-Newton steps on the likelihood.
[[nodiscard]] Fit fit_starts(const Problem& problem, Fit fit, int rounds);

/// Sandwich of `theta` with the noise as it is: covariance I^-1 J I^-1 and TIC's penalty tr(I^-1 J), I from
/// the values' scores, J from those of blocks (Takeuchi 1976).
struct Sandwich {
  Eigen::MatrixXd covariance;
  double penalty = 0;
};
[[nodiscard]] Sandwich sandwich(const Problem& problem, const Fit& fit, const std::vector<Index>& theta);

}  // namespace crane::innovations
