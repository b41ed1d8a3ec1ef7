#pragma once
/// All roots of a quasi-polynomial in a region of the complex plane. The argument principle gives the number
/// of roots in a box. The box is divided until Newton's method has found this number of different roots. The
/// count is exact: along the edge of a box, each step is so small that, by Taylor's theorem, f changes by
/// less than |f|.
#include "crane/analysis/quasi_polynomial.hpp"

namespace crane::analysis {

/// Re in [left, right], Im in [bottom, top].
struct Box {
  double left = 0, right = 0, bottom = 0, top = 0;
};

/// Number of roots in the box, counted with multiplicity. @throws std::domain_error when a root is on the
/// edge
[[nodiscard]] int count_roots(const QuasiPolynomial& f, const Box& box);

/// All roots with left <= Re s <= right and 0 <= Im s <= top, ordered by decreasing Re s. The roots below the
/// real axis are their conjugates. Multiple roots are repeated. Two roots closer than 1e-4 (1 + |s|) may be
/// returned as one double root.
/// @throws std::invalid_argument for f with a problem() or an empty region
/// @throws std::domain_error when every tried box has a root on its edge
[[nodiscard]] std::vector<Complex> roots_in(const QuasiPolynomial& f, double left, double right, double top);

/// All roots with Re s >= abscissa and Im s >= 0.
/// @throws std::invalid_argument when f has a problem(); the exceptions of root_bound() and roots_in()
[[nodiscard]] std::vector<Complex> roots_right_of(const QuasiPolynomial& f, double abscissa);

}  // namespace crane::analysis
