#include "search/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "rules.hpp"

namespace crane::diagnosis {
namespace {

constexpr int kResamples = static_cast<int>(rules::kResamples.count());

/// Windows of one part with starts that minimise the error in m or rad. A start that minimises the whitened
/// error may leave a larger error in m or rad than a load at rest.
struct PlainFits {
  const Problem& problem;
  Fits fits;

  PlainFits(const Problem& windows, const Crane& crane)
      : problem{windows}, fits{problem.fit(replays_of(problem.runs(), crane))} {}
  /// Mean squares by window, of one output.
  [[nodiscard]] std::vector<double> mean_squares(std::size_t output) const {
    std::vector<double> result = problem.squares_left(fits, output);
    for (std::size_t w = 0; w < result.size(); ++w)
      result[w] /= static_cast<double>(problem.measured_rows(problem.windows()[w], output));
    return result;
  }
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}

/// Mean squares of two models by output and window: before (base) and after (extended).
struct Compared {
  std::vector<std::vector<double>> before, after;
  std::vector<double> noise;
};

double gain_of(const Compared& c, const std::vector<std::vector<std::size_t>>* picked) {
  double before = 0, after = 0;
  for (std::size_t o = 0; o < c.before.size(); ++o) {
    double b = 0, a = 0;
    const std::size_t n = c.before[o].size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t at = picked != nullptr ? (*picked)[o][i] : i;
      b += c.before[o][at], a += c.after[o][at];
    }
    const double weight = 1 / (static_cast<double>(n) * c.noise[o] * c.noise[o]);
    before += weight * b, after += weight * a;
  }
  return before > 0 ? 1 - std::sqrt(after / before) : 0;
}

/// True if an effect acts directly on the output. True for every output if there are no effects.
bool acts_on(const Effects& effects, Output output) {
  return effects.empty() || std::any_of(effects.begin(), effects.end(), [&](const Effect& effect) {
           return effect.candidate->acts_on(output);
         });
}

/// Mean squares of measured - first measured value by window, for one output.
std::vector<double> held_value_squares(const Problem& problem, std::size_t output) {
  std::vector<double> result;
  for (const Window& window : problem.windows()) {
    const Eigen::VectorXd part = problem.measured_values(window, output);
    result.push_back((part.array() - part[0]).matrix().squaredNorm() / static_cast<double>(part.size()));
  }
  return result;
}

/// Standard deviation of the values for which `beside` is finite.
double scatter(const std::vector<double>& all, const std::vector<double>& beside) {
  std::vector<double> values;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (std::isfinite(beside[k])) values.push_back(all[k]);
  const double middle = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Simulated outputs of every run in open loop, by row.
std::vector<std::vector<double>> simulated_outputs(const Problem& whole, const Crane& crane) {
  std::vector<std::vector<double>> all;
  const Replays replays = replays_of(whole.runs(), crane);
  const Fits fits = whole.fit(replays);
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const std::size_t run = whole.windows()[w].run, rows = whole.runs()[run].run.rows();
    const Eigen::VectorXd& start = fits[w].start;
    std::vector<double>& outputs = all.emplace_back(rows * whole.outputs().size());
    replays[run].run(whole.part(), 0, rows, {start.data(), static_cast<std::size_t>(start.size())}, outputs);
  }
  return all;
}

}  // namespace

std::vector<Trace> traces(const Study& study, const Study& as_measured, const Fitted& fitted) {
  std::vector<Trace> all;
  const Crane extended = study.crane(fitted.nuisance.inaccuracies, fitted.effects);
  for (const auto& [problem, problem_as_measured] :
       {std::pair{&study.test().drive, &as_measured.test().drive},
        {&study.test().load, &as_measured.test().load}}) {
    const Problem whole(problem->runs(), problem->part(), kWholeRun, 0);
    const Problem whole_as_measured(problem_as_measured->runs(), problem->part(), kWholeRun, 0);
    const auto before = simulated_outputs(whole_as_measured, study.base()),
               after = simulated_outputs(whole, extended);
    for (std::size_t w = 0; w < whole.windows().size(); ++w) {
      const std::size_t number = whole.windows()[w].run;
      const Run& run = whole_as_measured.runs()[number].run;
      for (std::size_t i = 0; i < whole.outputs().size(); ++i) {
        const Output output = whole.outputs()[i];
        Trace trace{run.name, kOutputNames[output], {}, run.measured[output], {}, {}};
        const auto first = static_cast<std::ptrdiff_t>(i * run.rows()),
                   last = first + static_cast<std::ptrdiff_t>(run.rows());
        trace.baseline.assign(before[w].begin() + first, before[w].begin() + last);
        trace.extended.assign(after[w].begin() + first, after[w].begin() + last);
        for (std::size_t k = 0; k < run.rows(); ++k) {
          trace.time_s.push_back(run.start_s + run.instant_s(k));
          if (run.is_measured(output, k))
            trace.extended[k] += run.measured[output][k] - whole.runs()[number].run.measured[output][k];
        }
        all.push_back(std::move(trace));
      }
    }
  }
  return all;
}

HeldOut held_out(const Study& study, const Study& as_measured, const Fitted& fitted, std::uint64_t seed) {
  HeldOut result;
  if (study.test().drive.empty() && study.test().load.empty()) return result;
  const Crane extended = study.crane(fitted.nuisance.inaccuracies, fitted.effects);
  Compared compared;
  for (const auto& [as_it_was, problem, learned] :
       {std::tuple{&as_measured.test().drive, &study.test().drive, &study.train().drive},
        {&as_measured.test().load, &study.test().load, &study.train().load}}) {
    if (problem->empty()) continue;
    const PlainFits before{*as_it_was, study.base()}, after{*problem, extended}, trained{*learned, extended};
    for (std::size_t o = 0; o < problem->outputs().size(); ++o) {
      const std::string name = kOutputNames[problem->outputs()[o]];
      std::vector<double> then = before.mean_squares(o), now = after.mean_squares(o);
      result.baseline_rms[name] = std::sqrt(mean(then));
      result.extended_rms[name] = std::sqrt(mean(now));
      result.noise[name] = std::max(least_noise_of(learned->runs(), problem->outputs()[o]),
                                    std::sqrt(mean(trained.mean_squares(o))));
      if (acts_on(fitted.effects, problem->outputs()[o])) {
        compared.before.push_back(std::move(then));
        compared.after.push_back(std::move(now));
        compared.noise.push_back(result.noise[name]);
      }
      result.held_value_rms[name] = std::sqrt(mean(held_value_squares(*problem, o)));
    }
  }
  result.gain = gain_of(compared, nullptr);
  std::mt19937_64 random(seed + 29);
  std::vector<double> gains;
  for (int i = 0; i < kResamples; ++i) {
    std::vector<std::vector<std::size_t>> picked;
    for (const auto& squares_of : compared.before) {
      picked.emplace_back(squares_of.size());
      for (std::size_t& at : picked.back()) at = static_cast<std::size_t>(random() % squares_of.size());
    }
    gains.push_back(gain_of(compared, &picked));
  }
  std::sort(gains.begin(), gains.end());
  const auto quantile = [&](double share) {
    return gains[static_cast<std::size_t>(std::lround(share * kResamples))];
  };
  result.gain_ci95 = {quantile((1 - rules::kGainLevel) / 2), quantile((1 + rules::kGainLevel) / 2)};
  std::map<std::string, double> rows, measured_motion, simulated_motion;
  for (const Trace& trace : traces(study, as_measured, fitted)) {
    measured_motion[trace.column] += scatter(trace.measured, trace.measured);
    simulated_motion[trace.column] += scatter(trace.extended, trace.measured);
    const auto first =
        std::find_if(trace.measured.begin(), trace.measured.end(), [](double x) { return std::isfinite(x); });
    for (std::size_t k = 0; k < trace.measured.size(); ++k) {
      if (!std::isfinite(trace.measured[k])) continue;
      ++rows[trace.column];
      result.whole_held_value_rms[trace.column] += std::pow(trace.measured[k] - *first, 2);
      result.whole_baseline_rms[trace.column] += std::pow(trace.measured[k] - trace.baseline[k], 2);
      result.whole_extended_rms[trace.column] += std::pow(trace.measured[k] - trace.extended[k], 2);
    }
  }
  for (const auto& [name, motion] : measured_motion)
    result.whole_extended_motion[name] = motion > 0 ? simulated_motion[name] / motion : 1;
  for (auto* rms : {&result.whole_baseline_rms, &result.whole_extended_rms, &result.whole_held_value_rms})
    for (auto& [name, value] : *rms) value = std::sqrt(value / rows[name]);
  return result;
}

}  // namespace crane::diagnosis
