#pragma once
/// Describes a diagnosis in words.
#include <string>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

/// @return sentences that state, in this order: the verdict with causes and rivals; the held-out likelihood,
/// when noise and disturbance hide the decrease of the held-out error; the calibrated values that are at the
/// bound of the stated accuracy
[[nodiscard]] std::string sentence_of(const Diagnosis& diagnosis);

}  // namespace crane::diagnosis
