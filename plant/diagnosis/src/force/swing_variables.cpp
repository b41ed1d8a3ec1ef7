#include "force/swing_variables.hpp"

#include <algorithm>

#include "replay/travel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;

constexpr std::size_t kPlaces = 12, kSizes = 9, kTimes = 5;

/// Swing, rate and support in the windows. The measured swing contains the disturbance and is therefore
/// correlated with the residual of a correct model; the simulated swing is not.
class Signals {
 public:
  Signals(const Problem& problem, const Fits& fits) : problem_(problem), fits_(fits) {}

  /// @param at of a run and its row
  template <class At>
  [[nodiscard]] WindowSignal measured(At&& at) const {
    WindowSignal all;
    for (const Window& window : problem_.windows()) {
      std::vector<double>& of_window = all.emplace_back();
      for (std::size_t k = 0; k < window.rows; ++k)
        of_window.push_back(at(problem_.runs()[window.run], window.first + k));
    }
    return all;
  }

  [[nodiscard]] WindowSignal swing(std::size_t output) const {
    WindowSignal all;
    for (std::size_t w = 0; w < fits_.size(); ++w) {
      const std::size_t rows = problem_.windows()[w].rows;
      std::vector<double>& of_window = all.emplace_back();
      for (std::size_t k = 0; k < rows; ++k)
        of_window.push_back(fits_[w].simulated[static_cast<Index>(output * rows + k)]);
    }
    return all;
  }

  /// Central differences; one-sided at the ends.
  [[nodiscard]] WindowSignal rate(std::size_t output) const {
    WindowSignal all = swing(output);
    for (std::size_t w = 0; w < all.size(); ++w) {
      const std::vector<double> position = all[w];
      const double period_s = problem_.motion(output, w).period_s;
      for (std::size_t k = 0; k < position.size(); ++k) {
        const std::size_t before = k > 0 ? k - 1 : k, after = std::min(k + 1, position.size() - 1);
        all[w][k] = (position[after] - position[before]) / (period_s * static_cast<double>(after - before));
      }
    }
    return all;
  }

 private:
  const Problem& problem_;
  const Fits& fits_;
};

Kinematics kinematics(const PreparedRun& run, Output output, std::size_t row) {
  return at_row(run.motion[output], row);
}

}  // namespace

std::vector<SwingVariable> swing_variables_of(const Problem& problem, const Fits& fits, std::size_t index) {
  const Runs& runs = problem.runs();
  const Output output = problem.outputs()[index];
  const Signals signals(problem, fits);
  const WindowSignal one = signals.measured([](const PreparedRun&, std::size_t) { return 1.0; });
  const WindowSignal time = signals.measured(
      [](const PreparedRun& run, std::size_t row) { return static_cast<double>(row) * run.run.period_s; });
  const WindowSignal swing = signals.swing(index), swing_rate = signals.rate(index);
  std::vector<SwingVariable> all;
  for (const bool sensor : {false, true}) {
    const auto add = [&](const std::string& of, std::size_t bins, const WindowSignal& value,
                         const WindowSignal& factor) {
      all.push_back({std::string{kOutputNames[output]} + (sensor ? ": sensor, " : ": force, ") + of, sensor,
                     bins, value, factor, false});
    };
    for (const bool rate : {false, true}) {
      add(rate ? "rate of the swing" : "swing", kSizes, rate ? swing_rate : swing, one);
      all.back().of_own_swing = true;
    }
    add("time", kTimes, time, one);
    add("swing over time", kTimes, time, swing);
    add("rate of the swing over time", kTimes, time, swing_rate);
    for (const Output drive : {kTrolleyPosition, kSlewAngle}) {
      if (runs[0].motion[drive].position.empty()) continue;
      const std::string name = axis_of(drive);
      const WindowSignal place = signals.measured(
          [drive](const PreparedRun& run, std::size_t row) { return kinematics(run, drive, row).position; });
      const WindowSignal speed = signals.measured(
          [drive](const PreparedRun& run, std::size_t row) { return kinematics(run, drive, row).rate; });
      add("position of the " + name, kPlaces, place, one);
      add("speed of the " + name, kSizes, speed, one);
      add("swing by position of the " + name, kSizes, place, swing);
      add("rate of the swing by position of the " + name, kSizes, place, swing_rate);
    }
    for (std::size_t other = 0; other < problem.outputs().size(); ++other) {
      if (other == index) continue;
      add("other swing", kSizes, signals.swing(other), one);
      add("rate of the other swing", kSizes, signals.rate(other), one);
    }
  }
  std::erase_if(all, [](const SwingVariable& variable) {
    Extent range;
    for (const std::vector<double>& run : variable.value)
      for (const double value : run) range.take(value);
    return !(range.width() > 0);
  });
  return all;
}

}  // namespace crane::diagnosis
