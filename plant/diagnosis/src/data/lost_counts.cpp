#include "data/lost_counts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "data/median.hpp"

namespace crane::diagnosis {
namespace {

/// A clear jump exceeds kClearCounts, and kClearJumpRatio times the changes of the steps around it.
constexpr double kClearCounts = 12, kClearJumpRatio = 4;
constexpr std::size_t kFewestClearJumps = 5;
/// Expected false jumps of a run, if the steps around are noise with Laplace tails.
constexpr double kFalseJumps = 0.01;
/// Rows on each side that estimate the noise of the steps.
constexpr std::size_t kNoiseRows = 50;
/// Share of the usual jump of a losing encoder above which a smaller jump also counts as a jump.
constexpr double kUsualShare = 0.4;
/// Steps on one side of a jump that estimate the acceleration, and the nearest ones, which estimate the
/// speed.
constexpr std::size_t kSideSteps = 6, kNearestSteps = 3;
constexpr int kMostRemovalRounds = 4;

struct Jump {
  std::size_t row = 0;  ///< first row after the jump
  double size = 0;
};

/// Measured rows of a run.
struct Rows {
  std::vector<std::size_t> row;
  std::vector<double> position;
  std::vector<double> periods;        ///< from the row before
  std::vector<double> credible_slip;  ///< largest slip from the row before, from rest to rest
};

/// Largest slip in a time t from rest to rest, half accelerated, half braked: a t^2 / 4. Motor and friction
/// together accelerate at most twice as much as the largest command of the last kSlipRows rows.
double credible_slip_of(const Run& run, Output axis, double gain, std::size_t row, double time_s) {
  constexpr std::size_t kSlipRows = 5;
  double most_v = 0;
  for (std::size_t k = row - std::min(row, kSlipRows); k <= row; ++k)
    most_v = std::max(most_v, std::abs(run.command_v[k][axis]));
  return 2 * gain * most_v * 0.25 * time_s * time_s;
}

/// @param gain of the drive, acceleration per volt
Rows measured_rows(const Run& run, Output axis, double gain) {
  Rows rows;
  const bool regular = run.regular(axis);
  for (std::size_t k = 0; k < run.measured[axis].size(); ++k) {
    if (!run.is_measured(axis, k)) continue;
    const double time_s = rows.row.empty() ? run.period_s : run.instant_s(k) - run.instant_s(rows.row.back());
    rows.periods.push_back(regular ? 1 : time_s / run.period_s);
    rows.credible_slip.push_back(credible_slip_of(run, axis, gain, k, time_s));
    rows.row.push_back(k);
    rows.position.push_back(run.measured[axis][k]);
  }
  return rows;
}

/// Steps per period, m or rad.
std::vector<double> steps_of(const Rows& rows) {
  std::vector<double> steps;
  steps.reserve(rows.position.size());
  for (std::size_t k = 1; k < rows.position.size(); ++k)
    steps.push_back((rows.position[k] - rows.position[k - 1]) / rows.periods[k]);
  return steps;
}

/// Step minus the mean of its neighbours; 0 at the ends.
std::vector<double> deviations_of(const std::vector<double>& steps) {
  std::vector<double> deviations(steps.size(), 0.0);
  for (std::size_t k = 1; k + 1 < steps.size(); ++k)
    deviations[k] = steps[k] - 0.5 * (steps[k - 1] + steps[k + 1]);
  return deviations;
}

/// Threshold of a deviation: a Laplace distribution with the median deviation b of the rows around exceeds b
/// ln(1/p) with probability p.
double beyond_noise(const std::vector<double>& deviations, std::size_t k) {
  const std::size_t first = k - std::min(k, kNoiseRows),
                    last = std::min(k + kNoiseRows + 1, deviations.size());
  std::vector<double> around;
  for (std::size_t i = first; i < last; ++i) around.push_back(std::abs(deviations[i]));
  const double b = median(std::move(around)) / std::log(2.0);
  return b * std::log(static_cast<double>(deviations.size()) / kFalseJumps);
}

std::vector<Jump> clear_jumps(const Rows& rows, double count) {
  std::vector<Jump> found;
  const std::vector<double> s = steps_of(rows), deviations = deviations_of(s);
  for (std::size_t k = 2; k + 2 < s.size(); ++k) {
    const double size = deviations[k];
    const double rough = std::max(
        {std::abs(s[k + 1] - s[k - 1]), std::abs(s[k - 2] - s[k - 1]), std::abs(s[k + 2] - s[k + 1])});
    const double jump = size * rows.periods[k + 1];
    if (std::abs(size) > kClearJumpRatio * rough && std::abs(size) > kClearCounts * count &&
        std::abs(jump) > rows.credible_slip[k + 1] && std::abs(size) > beyond_noise(deviations, k))
      found.push_back({k + 1, jump});
  }
  return found;
}

/// Step at `k`, extrapolated from one side by robust speed and acceleration. @param towards -1: steps before
/// `k`; 1: steps after `k`
std::optional<double> expected(const std::vector<double>& steps, std::size_t k, int towards) {
  std::vector<double> side, changes, guesses;
  for (std::size_t d = 1; d <= kSideSteps; ++d) {
    if (towards < 0 ? k < d : k + d >= steps.size()) break;
    side.push_back(steps[towards < 0 ? k - d : k + d]);
  }
  if (side.size() < kSideSteps) return std::nullopt;
  for (std::size_t i = 0; i + 1 < side.size(); ++i) changes.push_back(side[i] - side[i + 1]);
  const double change = median(std::move(changes));
  for (std::size_t i = 0; i < kNearestSteps; ++i)
    guesses.push_back(side[i] + change * static_cast<double>(i + 1));
  return median(std::move(guesses));
}

/// Jumps: steps outside the range of the steps that are extrapolated from both sides. A step inside this
/// range is a change of speed by an impact or a push. The size of a jump is relative to the motion before it,
/// because the controller reacts to the jump.
std::vector<Jump> likely_jumps(const Rows& rows, double usual) {
  std::vector<Jump> found;
  const std::vector<double> steps = steps_of(rows);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const auto before = expected(steps, k, -1), after = expected(steps, k, 1);
    if (!before && !after) break;
    const double left = before.value_or(after.value_or(0)), right = after.value_or(left);
    const double outside = std::max(steps[k] - std::max(left, right), std::min(left, right) - steps[k]);
    const double periods = rows.periods[k + 1];
    if (periods * outside > std::max(kUsualShare * usual, rows.credible_slip[k + 1]))
      found.push_back({k + 1, periods * (steps[k] - left)});
  }
  return found;
}

void subtract(std::vector<double>& position, const std::vector<Jump>& jumps) {
  double lost = 0;
  auto next = jumps.begin();
  for (std::size_t k = 0; k < position.size(); ++k) {
    for (; next != jumps.end() && next->row == k; ++next) lost += next->size;
    position[k] -= lost;
  }
}

/// Removes jumps in rounds, because a jump may be visible only after the removal of another jump beside it.
/// @return all
std::vector<Jump> remove_jumps(Rows& rows, double usual) {
  std::vector<Jump> all;
  for (int round = 0; round < kMostRemovalRounds; ++round) {
    const std::vector<Jump> found = likely_jumps(rows, usual);
    if (found.empty()) break;
    subtract(rows.position, found);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

double median_size(const std::vector<Jump>& jumps) {
  std::vector<double> sizes;
  sizes.reserve(jumps.size());
  for (const Jump& jump : jumps) sizes.push_back(std::abs(jump.size));
  return median(std::move(sizes));
}

double distance_of(const std::vector<double>& position) {
  double distance = 0;
  for (std::size_t k = 1; k < position.size(); ++k) distance += std::abs(position[k] - position[k - 1]);
  return distance;
}

double drive_gain_of(const configuration::Rig& rig, Output axis) {
  return axis == kSlewAngle ? rig.plant.slew_gain_radps2pv : rig.plant.trolley_gain_mps2pv;
}

LosingEncoder measured(const std::vector<Run>& runs, Output axis, double gain, double usual) {
  LosingEncoder encoder{.axis = axis, .jump = usual};
  double distance = 0, squares = 0, deviations = 0;
  for (const Run& run : runs) {
    if (!run.has(axis)) continue;
    Rows rows = measured_rows(run, axis, gain);
    for (const Jump& jump : remove_jumps(rows, usual)) {
      ++encoder.jumps;
      encoder.lost += jump.size;
      squares += jump.size * jump.size;
      deviations += std::pow(std::abs(jump.size) - usual, 2);
    }
    encoder.duration_s += run.duration_s();
    distance += distance_of(rows.position);
  }
  constexpr double kMedianErrorRatio = 1.25;  // standard error of a median over that of a mean
  const auto count = static_cast<double>(std::max<std::size_t>(1, encoder.jumps));
  encoder.jump_std_dev = kMedianErrorRatio * std::sqrt(deviations) / count;
  encoder.rate = distance > 0 ? encoder.lost / distance : 0;
  encoder.rate_std_dev = distance > 0 ? std::sqrt(squares) / distance : 0;  // jumps come at random
  return encoder;
}

}  // namespace

std::vector<LosingEncoder> losing_encoders(const std::vector<Run>& runs, const configuration::Rig& rig) {
  std::vector<LosingEncoder> losing;
  for (const Output axis : {kTrolleyPosition, kSlewAngle}) {
    const double counts_per_unit = rig.encoders[axis].counts_per_unit;
    if (!(counts_per_unit > 0)) continue;
    const double gain = drive_gain_of(rig, axis);
    std::vector<Jump> clear;
    for (const Run& run : runs) {
      const double count = std::max(1 / counts_per_unit, run.resolution[axis]);
      for (const Jump& jump : clear_jumps(measured_rows(run, axis, gain), count)) clear.push_back(jump);
    }
    if (clear.size() >= kFewestClearJumps) losing.push_back(measured(runs, axis, gain, median_size(clear)));
  }
  return losing;
}

std::vector<Run> without_count_losses(std::vector<Run> runs, const std::vector<LosingEncoder>& losing,
                                      const configuration::Rig& rig) {
  for (const LosingEncoder& encoder : losing)
    for (Run& run : runs) {
      Rows rows = measured_rows(run, encoder.axis, drive_gain_of(rig, encoder.axis));
      (void)remove_jumps(rows, encoder.jump);
      for (std::size_t i = 0; i < rows.row.size(); ++i)
        run.measured[encoder.axis][rows.row[i]] = rows.position[i];
    }
  return runs;
}

}  // namespace crane::diagnosis
