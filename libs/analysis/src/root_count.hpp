#pragma once
#include <optional>

#include "crane/analysis/roots.hpp"

namespace crane::analysis {

/// Number of roots by the argument principle; nothing when a root is on the edge or too close to it.
[[nodiscard]] std::optional<int> roots_inside(const QuasiPolynomial& f, const Box& box);

}  // namespace crane::analysis
