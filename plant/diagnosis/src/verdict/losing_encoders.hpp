#pragma once
/// Encoders that lose counts, in the verdict.
#include "crane/diagnosis/diagnosis.hpp"
#include "data/lost_counts.hpp"

namespace crane::diagnosis {

/// Adds the encoders that lose counts to the causes. @pre !losing.empty()
/// @param train_gain decrease of the training loss of the base model by the restored counts
void name_losing(const std::vector<LosingEncoder>& losing, double train_gain, Diagnosis& diagnosis);

}  // namespace crane::diagnosis
