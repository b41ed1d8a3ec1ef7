#include "sanity/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

using Channels = std::array<double, kChannels>;

/// noise-weighted squares of a choice of windows
double weighted(const OpenLoop& loop, const std::vector<std::size_t>& choice, const Channels& noise) {
  Channels squares{}, values{};
  for (const std::size_t w : choice)
    for (std::size_t c = 0; c < kChannels; ++c) {
      squares[c] += loop.windows[w].squares[c];
      values[c] += static_cast<double>(loop.windows[w].values[c]);
    }
  double sum = 0;
  for (std::size_t c = 0; c < kChannels; ++c)
    if (values[c] > 0 && noise[c] > 0) sum += squares[c] / values[c] / (noise[c] * noise[c]);
  return std::sqrt(sum);
}

void set_gain(const OpenLoop& base, const OpenLoop& extended, const Channels& noise, std::uint64_t seed,
              diagnosis::HeldOut& out) {
  const std::size_t count = std::min(base.windows.size(), extended.windows.size());
  if (count == 0) return;
  std::vector<std::size_t> choice(count);
  for (std::size_t i = 0; i < count; ++i) choice[i] = i;
  const auto gain = [&] {
    const double before = weighted(base, choice, noise);
    return before > 0 ? 1 - weighted(extended, choice, noise) / before : 0;
  };
  out.gain = gain();
  std::mt19937_64 random{seed};
  std::uniform_int_distribution<std::size_t> pick{0, count - 1};
  std::vector<double> gains(1000);
  for (double& g : gains) {
    for (std::size_t& i : choice) i = pick(random);
    g = gain();
  }
  std::sort(gains.begin(), gains.end());
  const double tail = 0.5 * rule::kGainLevel.value;
  out.gain_ci95 = {gains[static_cast<std::size_t>(tail * 1000)],
                   gains[static_cast<std::size_t>((1 - tail) * 1000) - 1]};
}

Fit as_fit(const Problem& problem, const Hypothesis& of) {
  Fit fit{{of.values, {}}, 0, log_likelihoods(problem, {of.values, {}})};
  fit.value = fit.usable() ? sum(fit.by_value) + log_prior(problem, of.values) : -1e300;
  return fit_starts(problem, std::move(fit), 6);
}

std::map<std::string, double> named(const Channels& values, const Problem& problem) {
  std::map<std::string, double> by_name;
  for (std::size_t c = 0; c < kChannels; ++c)
    if (std::any_of(problem.runs.begin(), problem.runs.end(),
                    [&](const Run& r) { return !r.measured[c].empty(); }))
      by_name[kChannelNames[c]] = values[c];
  return by_name;
}

void refuse(const Model& extended, HeldOutJudgement& j) {
  const auto& e = j.errors;
  if (e.gain_ci95[0] <= 0)
    j.refused.push_back("the held-out windows are not simulated better beyond resampling");
  for (const Candidate& cause : extended.causes)
    for (const std::size_t c : cause.channels) {
      const std::string column = kChannelNames[c];
      if (!e.whole_baseline_rms.contains(column)) continue;
      const double whole = e.whole_extended_rms.at(column), held = e.whole_held_value_rms.at(column);
      if (!(whole <= rule::kWorseWhole.value * e.whole_baseline_rms.at(column)))
        j.refused.push_back(column + " is worse over whole runs");
      if (e.whole_extended_motion.at(column) < rule::kLeastMotion.value)
        j.refused.push_back(column + " hardly moves in the extended model");
      if (e.extended_rms.at(column) > e.held_value_rms.at(column) && held > 0)
        j.refused.push_back(column + " is simulated worse than a value that stays, in windows");
    }
  std::sort(j.refused.begin(), j.refused.end());
  j.refused.erase(std::unique(j.refused.begin(), j.refused.end()), j.refused.end());
}

}  // namespace

HeldOutJudgement judge_held_out(const Problem& train, const Problem& test, const Model& base,
                                const Model& extended, std::uint64_t seed) {
  HeldOutJudgement j;
  const Fit before = as_fit(test, base.fit.at), after = as_fit(test, extended.fit.at);
  if (before.usable() && after.usable()) {
    const auto d = block_sums(blocks_of(test), difference(after.by_value, before.by_value));
    const double tail = 0.5 * rule::kGainLevel.value;
    j.nats = sum(d);
    j.nats_ci95 = {resampled_sum(d, tail, seed), resampled_sum(d, 1 - tail, seed)};
  }
  const double window = rule::kWindow.value;
  const Channels noise = open_loop(train, extended.fit.at, window).rms();
  const OpenLoop b = open_loop(test, before.at, window), e = open_loop(test, after.at, window);
  const OpenLoop whole_b = open_loop(test, before.at, 0), whole_e = open_loop(test, after.at, 0);
  j.errors.baseline_rms = named(b.rms(), test), j.errors.extended_rms = named(e.rms(), test);
  j.errors.noise = named(noise, test);
  j.errors.whole_baseline_rms = named(whole_b.rms(), test),
  j.errors.whole_extended_rms = named(whole_e.rms(), test);
  j.errors.held_value_rms = named(b.held_rms(), test),
  j.errors.whole_held_value_rms = named(whole_b.held_rms(), test);
  j.errors.whole_extended_motion = named(whole_e.motion_share(), test);
  set_gain(b, e, noise, seed, j.errors);
  if (!extended.causes.empty()) refuse(extended, j);
  return j;
}

}  // namespace crane::innovations
