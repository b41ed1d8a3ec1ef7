#pragma once
/// Exact roots of a quasi-polynomial in a part of the plane, none missed: the argument principle says how
/// many a box holds, the box is divided until Newton's method has found as many different ones in it. Around
/// a box it walks in steps over which Taylor's theorem keeps the change of f below |f|, so the count is not a
/// sampled guess.
#include "crane/analysis/quasi_polynomial.hpp"

namespace crane::analysis {

/// Re in [left, right], Im in [bottom, top].
struct Box {
  double left = 0, right = 0, bottom = 0, top = 0;
};

/// Roots inside, with their multiplicity. @throws std::domain_error when one lies on the edge
[[nodiscard]] int count_roots(const QuasiPolynomial& f, const Box& box);

/// Roots with left <= Re s <= right and 0 <= Im s <= top (those below the real axis mirror them), the
/// right-most first, multiple ones repeated. Two roots closer than 1e-4 (1 + |s|) may be given as one double
/// root.
/// @throws std::invalid_argument for f with a problem() or an empty region
[[nodiscard]] std::vector<Complex> roots_in(const QuasiPolynomial& f, double left, double right, double top);

/// All roots with Re s >= abscissa and Im s >= 0. @throws std::invalid_argument as root_bound
[[nodiscard]] std::vector<Complex> roots_right_of(const QuasiPolynomial& f, double abscissa);

}  // namespace crane::analysis
