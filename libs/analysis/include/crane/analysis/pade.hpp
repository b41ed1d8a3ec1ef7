#pragma once
/// Roots with the approximation (3.49) of the delay, for comparison with the exact roots.
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
///   exp(-tau s) ~ ((1 - tau s / 2l) / (1 + tau s / 2l))^l                         (3.49)
#include "crane/analysis/quasi_polynomial.hpp"

namespace crane::analysis {

/// All roots with Im s >= 0, ordered by decreasing Re s: eigenvalues of the loop with l all-pass sections in
/// series.
/// @param order l >= 1. @throws std::invalid_argument for f with a problem(), a neutral f or order < 1
[[nodiscard]] std::vector<Complex> pade_roots(const QuasiPolynomial& f, int order);

}  // namespace crane::analysis
