#pragma once
/// Simulation without correction, in windows and over whole runs, each from the start that makes its error
/// least: Gauss-Newton from the filter's state, from the measured values and their slopes, and from rest.
#include "likelihood/problem.hpp"

namespace crane::innovations {

struct WindowError {
  std::array<double, kChannels> squares{}, held_squares{};     ///< sums; held: the first measured value kept
  std::array<double, kChannels> motion{}, simulated_motion{};  ///< sums of squares about the mean
  std::array<std::size_t, kChannels> values{};
  std::size_t run = 0;
};
struct OpenLoop {
  std::vector<WindowError> windows;

  [[nodiscard]] std::array<double, kChannels> rms() const;
  [[nodiscard]] std::array<double, kChannels> held_rms() const;
  /// Share of the measured motion that is simulated; 1 where nothing is measured.
  [[nodiscard]] std::array<double, kChannels> motion_share() const;
};

/// @param window_s length of windows; 0: whole runs
[[nodiscard]] OpenLoop open_loop(const Problem& problem, const Hypothesis& hypothesis, double window_s);

/// One simulated window, for pictures and tests: errors by value.
struct Simulated {
  Innovations out;
  Eigen::VectorXd start;
};
[[nodiscard]] Simulated simulate_best(const Problem& problem, const Hypothesis& hypothesis, const Run& window,
                                      const Eigen::VectorXd& guess);

}  // namespace crane::innovations
