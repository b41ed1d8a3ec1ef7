#pragma once
/// Encoders that lose counts, in the verdict.
#include "crane/diagnosis/diagnosis.hpp"
#include "data/lost_counts.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// Adds the encoders that lose counts to the causes.
/// @param study of the data with restored counts
/// @param as_measured of the same runs as measured, whitened alike
void name_losing(const std::vector<LosingEncoder>& losing, const Study& study, const Study& as_measured,
                 Diagnosis& diagnosis);

}  // namespace crane::diagnosis
