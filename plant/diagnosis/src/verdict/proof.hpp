#pragma once
/// Confirmation of an extended model by the held-out runs.
#include <string>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/hypothesis.hpp"

namespace crane::diagnosis {

/// Result of the held-out runs for the extended model.
struct Proof {
  enum class Outcome {
    proven,
    unlikely,        ///< the held-out likelihood is not significantly larger
    no_consequence,  ///< the likelihood is larger, but no error decreases
    refuted,         ///< the extended model follows the motion worse
  };
  Outcome outcome = Outcome::proven;
  std::string why;  ///< of all outcomes but `proven`
};

/// @return `proven` without effects or without held-out runs
[[nodiscard]] Proof proof_of(const HeldOut& held_out, const Effects& effects);

}  // namespace crane::diagnosis
