#pragma once
/// Which candidates are worth a fit: scores with the noise projected out (Rao, Proc. Camb. Phil. Soc. 44
/// (1948) 50), gains of the candidates' own starts, and a periodogram over position for waves.
#include "candidates/candidate.hpp"

namespace crane::innovations {

struct Screened {
  const Candidate* candidate = nullptr;
  double promised = 0;  ///< nats of a score step
  double gained = 0;    ///< nats of the best start as it is
  Hypothesis start;     ///< that start, or the base
  [[nodiscard]] double rank() const;
};

/// Best first. @param base fitted, of the causes found before
[[nodiscard]] std::vector<Screened> screen(const Problem& problem, const Fit& base,
                                           const std::vector<Candidate>& library);

/// Whitened, robustly weighted innovations y and sensitivities X: y + X a is what an amount a would leave.
struct Whitened {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
};
[[nodiscard]] Whitened whitened(const Problem& problem, const Hypothesis& at, const Columns& columns);

/// Likelihood periodogram over the position of a drive: a force a cos + b sin (2 pi p / w), with the sign of
/// the speed where it is friction.
struct Wave {
  double gain = 0, length = 0, cosine = 0, sine = 0;
};
[[nodiscard]] Wave strongest_wave(const Problem& problem, const Hypothesis& at, std::size_t drive,
                                  bool friction);

}  // namespace crane::innovations
