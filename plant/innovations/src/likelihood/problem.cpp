#include "likelihood/problem.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

/// First guesses of the noise, from the data's scales.
void guess_noise(const Problem& problem, Values& v) {
  const Scales& s = problem.scales;
  const Layout layout = layout_of(problem.rig, problem.runs, false);
  for (std::size_t c = 0; c < kChannels; ++c) {
    double resolution = 0;
    for (const Run& run : problem.runs) resolution = std::max(resolution, run.resolution[c]);
    v[of_noise(c, kLogSensor)] = std::log(std::max({1e-9, 0.3 * resolution, s.floor[c]}));
    const double force = c >= 2            ? 0.02 * s.load_n * std::min(s.swing_rad, 0.3)
                         : layout.volts[c] ? 0.1 * s.volts[c]
                                           : s.speed[c] / 0.3;
    v[of_noise(c, kLogForce)] = std::log(std::max(1e-7, force));
    v[of_noise(c, kLogCorrelation)] = c < 2 && !layout.volts[c] ? -1.5 : -1;
  }
}

}  // namespace

Problem::Problem(const runtime::Rig& of, std::vector<Run> all)
    : rig(of),
      runs(std::move(all)),
      scales(scales_of(rig, runs)),
      table(parameter_table(rig, scales)),
      base(null_values(table)),
      nominal(nominal_of(rig, base)) {
  for (Index i = 0; i < kNoiseBegin; ++i) {
    table[i].low = std::min(table[i].low, base[i]);
    table[i].high = std::max(table[i].high, base[i]);
  }
  guess_noise(*this, base);
}

Problem Problem::with_runs(std::vector<Run> other) const {
  Problem held = *this;
  held.runs = std::move(other);
  return held;
}

std::vector<Index> Problem::noise() const {
  std::vector<Index> free;
  const Layout layout = layout_of(rig, runs, false);
  for (std::size_t c = 0; c < kChannels; ++c) {
    if (!layout.has(kCoordinateOf[c])) continue;
    const bool measured =
        std::any_of(runs.begin(), runs.end(), [&](const Run& r) { return !r.measured[c].empty(); });
    free.push_back(of_noise(c, kLogForce));
    free.push_back(of_noise(c, kLogCorrelation));
    if (measured) free.push_back(of_noise(c, kLogSensor));
    if (c < 2 && layout.volts[c]) {
      free.push_back(standstill_of(c));
      free.push_back(command_noise_of(c));
    }
  }
  return free;
}

Innovations innovations(const Problem& problem, const Hypothesis& h, std::size_t run, const Columns* columns,
                        bool keep_states) {
  const CraneModel model{problem.nominal, problem.layout(h.values), h.values, problem.scales};
  FilterRequest request{problem.between, keep_states, columns, {}};
  if (run < h.starts.size()) request.start = h.starts[run];
  return filter(model, problem.nominal, problem.scales, problem.runs[run], h.values, request);
}

std::vector<double> log_likelihoods(const Problem& problem, const Hypothesis& h) {
  std::vector<double> all;
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const Innovations out = innovations(problem, h, r);
    if (!out.finite) return {};
    all.insert(all.end(), out.log_likelihood.begin(), out.log_likelihood.end());
  }
  return std::isfinite(sum(all)) ? all : std::vector<double>{};
}

double log_prior(const Problem& problem, const Values& v) {
  double log_density = 0;
  const auto gauss = [&](Index i, double mean, double deviation) {
    log_density -= 0.5 * std::pow((v[i] - mean) / deviation, 2);
  };
  for (const Index i : problem.noise()) {
    const bool correlation = i < kStandstillBegin && (i - kNoiseBegin) % kNoiseParameters == kLogCorrelation;
    if (correlation)
      gauss(i, -0.7, 1.5);
    else if (i >= kCommandNoiseBegin)
      gauss(i, problem.base[i], 3);
    else
      gauss(i, problem.base[i], 5);
  }
  return log_density;
}

Blocks blocks_of(const Problem& problem) {
  Blocks blocks;
  double all_s = 0;
  for (const Run& run : problem.runs) all_s += run.end_s() - run.begin_s();
  const double block_s = std::clamp(all_s / rule::kLeastBlocks.value, 1e-3, rule::kBlock.value);
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const Run& run = problem.runs[r];
    const double begin = run.begin_s(), seconds = run.end_s() - begin;
    const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(seconds / block_s));
    for (const Series& s : run.measured)
      for (const double t : s.time_s) {
        const auto k = static_cast<std::size_t>((t - begin) / (seconds + 1e-9) * static_cast<double>(count));
        blocks.of_value.push_back(blocks.count + std::min(k, count - 1));
      }
    blocks.count += count;
    blocks.run_of_block.insert(blocks.run_of_block.end(), count, r);
  }
  return blocks;
}

std::vector<double> block_sums(const Blocks& blocks, std::span<const double> values) {
  std::vector<double> sums(blocks.count, 0);
  for (std::size_t k = 0; k < values.size(); ++k) sums[blocks.of_value[k]] += values[k];
  return sums;
}

Eigen::MatrixXd scores(const Problem& problem, const Hypothesis& at, const std::vector<Index>& free,
                       const std::vector<double>& l0) {
  Eigen::MatrixXd s =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(l0.size()), static_cast<Eigen::Index>(free.size()));
  tbb::parallel_for(std::size_t{0}, free.size(), [&](std::size_t i) {
    const ParameterInfo& info = problem.table[free[i]];
    double step = 0.05 * info.scale;
    Hypothesis moved = at;
    if (moved.values[free[i]] + step > info.high) step = -step;
    moved.values[free[i]] += step;
    const auto l = log_likelihoods(problem, moved);
    if (l.empty()) return;
    for (std::size_t k = 0; k < l0.size(); ++k)
      s(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = (l[k] - l0[k]) / step;
  });
  return s;
}

double sum(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace crane::innovations
