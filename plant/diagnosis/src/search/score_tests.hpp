#pragma once
/// Score tests of a search. A test beside a hypothesis is computed once.
#include <cstdint>
#include <vector>

#include "study/score.hpp"

namespace crane::diagnosis {

class ScoreTests {
 public:
  explicit ScoreTests(std::uint64_t seed) : seed_(seed) {}

  /// Scores beside a hypothesis; valid until the next call. @param data in its noise
  [[nodiscard]] const ScoreTable& beside(const WhitenedData& data, const Fitted& given);
  /// Slopes of the probes of the base model.
  [[nodiscard]] const ProbeSlopes& probe_slopes() const { return probe_slopes_; }

 private:
  /// Score test beside a hypothesis, which its deviance identifies.
  struct Scored {
    Effects effects;
    Blocks deviance;
    ScoreTable table;
  };

  std::uint64_t seed_;
  std::vector<Scored> scored_;
  ProbeSlopes probe_slopes_;
};

}  // namespace crane::diagnosis
