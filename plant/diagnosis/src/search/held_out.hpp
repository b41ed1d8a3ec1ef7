#pragma once
/// Comparison of base model and extended model on the held-out runs.
#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// @param as_measured study of the same runs before lost counts were restored: the data of the base model;
/// `study` itself if no counts were lost
[[nodiscard]] HeldOut held_out(const Study& study, const Study& as_measured, const Fitted& fitted,
                               std::uint64_t seed);

/// Drive and load simulation of the whole held-out runs, each from its best start: the drives from command
/// and measured swing, the load from measured motion.
/// @param as_measured as above
[[nodiscard]] std::vector<Trace> traces(const Study& study, const Study& as_measured, const Fitted& fitted);

}  // namespace crane::diagnosis
