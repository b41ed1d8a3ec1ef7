#pragma once
/// Score tests of a search. A test beside a hypothesis is computed once.
#include <cstdint>
#include <vector>

#include "study/study.hpp"

namespace crane::diagnosis {

class ScoreTests {
 public:
  /// @param study must outlive this object
  ScoreTests(const Study& study, std::uint64_t seed) : study_(study), seed_(seed) {}

  /// Scores beside a hypothesis; valid until the next call.
  /// @pre the study is whitened with its nuisance parameters
  [[nodiscard]] const ScoreTable& beside(const Fitted& given);

 private:
  /// Score test beside a hypothesis, which its deviance identifies.
  struct Scored {
    Effects effects;
    Blocks deviance;
    ScoreTable table;
  };

  const Study& study_;
  std::uint64_t seed_;
  std::vector<Scored> scored_;
  ProbeSlopes probe_slopes_;
};

}  // namespace crane::diagnosis
