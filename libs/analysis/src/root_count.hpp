#pragma once
#include <optional>

#include "crane/analysis/roots.hpp"

namespace crane::analysis {

/// Argument principle; nothing when a root lies on the edge, or too near to tell.
[[nodiscard]] std::optional<int> roots_inside(const QuasiPolynomial& f, const Box& box);

}  // namespace crane::analysis
