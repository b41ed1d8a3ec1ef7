#pragma once
/// The likelihood of a hypothesis: the filter's innovations over all runs, and a wide prior on the noise.
#include <span>

#include "filter/kalman_filter.hpp"

namespace crane::innovations {

/// Everything that the hypotheses share. Immutable once made.
struct Problem {
  Problem(const runtime::Rig& rig, std::vector<Run> all);

  runtime::Rig rig;
  std::vector<Run> runs;
  Scales scales;
  ParameterTable table;
  Values base;  ///< the rig file's terms and first guesses of the noise
  Nominal nominal;
  Between between = Between::held;

  /// With the values of other runs' scales: held-out data are judged as the training data were.
  [[nodiscard]] Problem with_runs(std::vector<Run> other) const;
  [[nodiscard]] bool double_pendulum(const Values& v) const { return v[of_load(kLowerShare)] > 0; }
  [[nodiscard]] Layout layout(const Values& v) const { return layout_of(rig, runs, double_pendulum(v)); }
  [[nodiscard]] std::vector<Index> noise() const;  ///< indices that are free in every hypothesis
};

/// A hypothesis: values, and where each run's lower cable begins.
struct Hypothesis {
  Values values{};
  std::vector<RunStart> starts;  ///< by run; empty: in line with the upper cable
};

/// log likelihood of every value of every run, in the order of the runs and their slots; empty when the
/// filter diverges.
[[nodiscard]] std::vector<double> log_likelihoods(const Problem& problem, const Hypothesis& hypothesis);
[[nodiscard]] Innovations innovations(const Problem& problem, const Hypothesis& hypothesis, std::size_t run,
                                      const Columns* columns = nullptr, bool keep_states = false);

[[nodiscard]] double log_prior(const Problem& problem, const Values& values);

/// Block of time of every value, runs one after the other.
struct Blocks {
  std::vector<std::size_t> of_value;
  std::vector<std::size_t> run_of_block;
  std::size_t count = 0;
};
[[nodiscard]] Blocks blocks_of(const Problem& problem);
[[nodiscard]] std::vector<double> block_sums(const Blocks& blocks, std::span<const double> values);

/// Derivatives of every value's log likelihood by forward differences of the whole filter: a column per
/// parameter.
[[nodiscard]] Eigen::MatrixXd scores(const Problem& problem, const Hypothesis& at,
                                     const std::vector<Index>& free, const std::vector<double>& l0);

[[nodiscard]] double sum(std::span<const double> values);

}  // namespace crane::innovations
