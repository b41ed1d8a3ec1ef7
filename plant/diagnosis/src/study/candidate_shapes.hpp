#pragma once
/// Shapes of candidates, built from the parameters of their terms. A probe is a value at which the effect is
/// simulated.
#include <utility>
#include <vector>

#include "crane/diagnosis/candidate.hpp"

namespace crane::diagnosis {

/// Bounds of the term, narrowed to values that are plausible on a rig.
[[nodiscard]] FreeParameter free_parameter(const std::string& cause, const std::string& name, double low,
                                           double high, double step);

/// One amount without shape parameters.
[[nodiscard]] Candidate amount(const std::string& cause, const std::string& axis,
                               const std::string& parameter, double low, double high, double step);

/// `candidate` with additional probes at `settings`, which are also initial values of its fit.
[[nodiscard]] Candidate reaching(Candidate candidate, const std::vector<std::vector<double>>& settings);

/// One amount >= 0 with further parameters that give it a shape: a probe at each of `shapes`.
[[nodiscard]] Candidate shaped(const std::string& cause, const std::string& axis, const FreeParameter& size,
                               const std::vector<FreeParameter>& of_shape,
                               const std::vector<std::vector<double>>& shapes);

/// Amount and angle: probes at 0 and at a quarter turn.
[[nodiscard]] Candidate turned(const std::string& cause, const std::string& axis, const FreeParameter& size,
                               const FreeParameter& angle, const std::vector<FreeParameter>& of_shape,
                               const std::vector<std::vector<double>>& shapes);

/// Two amounts that are tested together.
[[nodiscard]] Candidate two_amounts(const std::string& cause, const std::string& axis,
                                    std::vector<FreeParameter> both);

/// Effect that small amounts do not describe (a resonance, a gap): a probe at each of `settings`, which are
/// the initial values of its fit.
[[nodiscard]] Candidate at_once(const std::string& cause, const std::string& axis,
                                std::vector<FreeParameter> parameters,
                                const std::vector<std::vector<double>>& settings);

/// Simulations that a candidate changes.
enum class Changes { drive, load, both };

/// States whether the rig file contains the quantity of a candidate.
enum class InRigFile { no, yes };

/// Candidates in the order of the report.
class CandidateList {
 public:
  void add(Candidate candidate, Changes changes, InRigFile quantity = InRigFile::no);
  [[nodiscard]] std::vector<Candidate> take() { return std::move(candidates_); }

 private:
  std::vector<Candidate> candidates_;
};

}  // namespace crane::diagnosis
