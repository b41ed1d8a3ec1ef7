#pragma once
/// A diagnosis in words.
#include <string>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

/// Verdict, causes and rivals; calibrated values at the bound of the stated accuracy; whether noise hides the
/// gain.
[[nodiscard]] std::string sentence_of(const Diagnosis& diagnosis);

}  // namespace crane::diagnosis
