#pragma once
/// Roots with the delay approximated as in the source, for comparison with the exact ones:
///   exp(-tau s) ~ ((1 - tau s / 2l) / (1 + tau s / 2l))^l                         (3.49)
#include "crane/analysis/quasi_polynomial.hpp"

namespace crane::analysis {

/// Every root with Im s >= 0, the right-most first: eigenvalues of the loop with l all-pass sections in
/// series.
/// @param order l >= 1. @throws std::invalid_argument for f with a problem(), a neutral f or order < 1
[[nodiscard]] std::vector<Complex> pade_roots(const QuasiPolynomial& f, int order);

}  // namespace crane::analysis
