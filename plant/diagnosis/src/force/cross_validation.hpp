#pragma once
/// Cross-validation and sign flips of patterns of force.
#include <cstdint>
#include <span>
#include <vector>

#include "force/normal_equations.hpp"
#include "rules.hpp"

namespace crane::diagnosis {

/// Folds of the patterns of drives and swing, and of the lines.
inline constexpr std::size_t kFolds = rules::kFolds.count();
/// The largest of 99 is exceeded by chance with a probability of 1 %.
inline constexpr std::size_t kFlips = rules::kFlips.count();

/// Small penalty of the amplitudes, on the diagonal of the Hessian.
[[nodiscard]] double ridge_of(const NormalEquations& all);

/// Sum of the gains of the folds; 0 unless at least three of the four gains are positive.
[[nodiscard]] double gain_of_folds(std::span<const double, kFolds> gains);

/// kFlips vectors of `count` random signs, 1 or -1.
[[nodiscard]] std::vector<Eigen::VectorXd> random_signs(Eigen::Index count, std::uint64_t seed);

}  // namespace crane::diagnosis
