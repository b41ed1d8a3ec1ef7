#pragma once
/// What a candidate may look like, built from the parameters of its term.
#include <utility>
#include <vector>

#include "crane/diagnosis/candidate.hpp"

namespace crane::diagnosis {

/// The bounds of the term's own documentation, narrowed to what is plausible on a rig.
[[nodiscard]] FreeParameter free_parameter(const std::string& cause, const std::string& name, double low,
                                           double high, double step);

/// One amount, no shape.
[[nodiscard]] Candidate amount(const std::string& cause, const std::string& axis,
                               const std::string& parameter, double low, double high, double step);

/// `candidate` looked at from afar as well: a probe at each of `settings`, where its fit may begin.
[[nodiscard]] Candidate reaching(Candidate candidate, const std::vector<std::vector<double>>& settings);

/// One amount >= 0 with further parameters that give it a shape: a probe at each of `shapes`.
[[nodiscard]] Candidate shaped(const std::string& cause, const std::string& axis, const FreeParameter& size,
                               const std::vector<FreeParameter>& of_shape,
                               const std::vector<std::vector<double>>& shapes);

/// Amount and angle: probes at 0 and at a quarter turn.
[[nodiscard]] Candidate turned(const std::string& cause, const std::string& axis, const FreeParameter& size,
                               const FreeParameter& angle, const std::vector<FreeParameter>& of_shape,
                               const std::vector<std::vector<double>>& shapes);

/// Two amounts that belong together.
[[nodiscard]] Candidate two_amounts(const std::string& cause, const std::string& axis,
                                    std::vector<FreeParameter> both);

/// What no small amount shows, a resonance or a gap: a probe at each of `settings`, where its fit begins.
[[nodiscard]] Candidate at_once(const std::string& cause, const std::string& axis,
                                std::vector<FreeParameter> parameters,
                                const std::vector<std::vector<double>>& settings);

/// Replays that a candidate changes.
enum class Changes { drive, load, both };

/// Quantity of a candidate in the rig file.
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
