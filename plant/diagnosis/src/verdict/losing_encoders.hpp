#pragma once
/// Encoders that lose counts, in the verdict.
#include "crane/diagnosis/diagnosis.hpp"
#include "data/lost_counts.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// Names them beside what is said about the rest of the model.
/// @param study of what has been put back
/// @param as_measured of the same runs before that, whitened alike
void name_losing(const std::vector<LosingEncoder>& losing, const Study& study, const Study& as_measured,
                 Diagnosis& diagnosis);

}  // namespace crane::diagnosis
