#pragma once
/// Forward search: one cause is added at a time while its cross-validated gain is beyond resampling and large
/// enough to matter; causes that later ones have made superfluous are dropped.
#include "candidates/screen.hpp"
#include "sanity/open_loop.hpp"
#include "select/cross_validation.hpp"

namespace crane::innovations {

struct Model {
  Fit fit;
  std::vector<Candidate> causes;
  std::vector<double> by_block;  ///< cross-validated log likelihood
  [[nodiscard]] double value() const { return sum(by_block); }
  [[nodiscard]] std::vector<Index> theta() const;
  [[nodiscard]] bool has(const Candidate& c) const;
};

/// One hypothesis that was fitted, for the report.
struct Tried {
  std::string label;
  double gain = 0;    ///< cross-validated nats over the model before
  double lower = 0;   ///< of the gain, at the detection level
  double effect = 0;  ///< largest share of the open-loop error that it removes in a column
  std::vector<Estimate> estimates;
};

struct SearchResult {
  Model base, model;
  std::vector<std::string> rivals;  ///< names that explain the last cause alike
  std::vector<Tried> tried;
  std::vector<double> frequency;  ///< by cause: share of resamples in which it beats its best rival
};

struct SearchOptions {
  std::size_t most_effects = 3;
  std::uint64_t seed = 1;
  std::vector<std::string> excluded;
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// @param problem its `between` is chosen here, by likelihood
[[nodiscard]] SearchResult search(Problem& problem, const SearchOptions& options);

}  // namespace crane::innovations
