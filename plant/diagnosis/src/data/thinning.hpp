#pragma once
/// Rows of runs that were sampled faster than anything of a crane moves.
#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

/// Every n-th row, at most 100 a second, with a note; a command is the mean over what it replaces.
[[nodiscard]] Loaded thinned(Loaded loaded);

}  // namespace crane::diagnosis
