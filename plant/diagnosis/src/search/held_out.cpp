#include "search/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace crane::diagnosis {
namespace {

using Eigen::Index;

constexpr int kResamples = 1000;

/// Mean squares of the plain residual by window, for one output of one part.
std::vector<double> mean_squares(const Problem& problem, const Fits& fits, std::size_t output) {
  std::vector<double> result = problem.squares_left(fits, output);
  for (std::size_t w = 0; w < result.size(); ++w) result[w] /= static_cast<double>(problem.windows()[w].rows);
  return result;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}

/// Two bodies of squares per output, before and after, by window.
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

/// Every run in open loop, by row.
std::vector<std::vector<double>> ways(const Problem& whole, const Crane& crane) {
  std::vector<std::vector<double>> all;
  const Replays replays = replays_of(whole.runs(), crane);
  const Fits fits = whole.fit(replays);
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const std::size_t run = whole.windows()[w].run, rows = whole.runs()[run].run.rows();
    const Eigen::VectorXd& start = fits[w].start;
    std::vector<double>& way = all.emplace_back(rows * whole.outputs().size());
    replays[run].run(whole.part(), 0, rows, {start.data(), static_cast<std::size_t>(start.size())}, way);
  }
  return all;
}

}  // namespace

std::vector<Trace> traces(const Study& study, const Study& as_measured, const Effects& effects) {
  std::vector<Trace> all;
  for (const auto& [problem, problem_as_measured] :
       {std::pair{&study.test_drive(), &as_measured.test_drive()},
        {&study.test_load(), &as_measured.test_load()}}) {
    const Problem whole(problem->runs(), problem->part(), kWholeRun, 0);
    const Problem whole_as_measured(problem_as_measured->runs(), problem->part(), kWholeRun, 0);
    const auto before = ways(whole_as_measured, study.base()), after = ways(whole, study.with(effects));
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
          trace.time_s.push_back(run.start_s + static_cast<double>(k) * run.period_s);
          trace.extended[k] += run.measured[output][k] - whole.runs()[number].run.measured[output][k];
        }
        all.push_back(std::move(trace));
      }
    }
  }
  return all;
}

HeldOut held_out(const Study& study, const Study& as_measured, const Effects& effects, std::uint64_t seed) {
  HeldOut result;
  if (study.test_drive().empty() && study.test_load().empty()) return result;
  const Evaluation& before = as_measured.base_test();
  const Evaluation after = study.test(effects), trained = study.train(effects);
  Compared compared;
  for (const auto& [old_problem, old_fits, problem, new_fits, learned, learned_fits] :
       {std::tuple{&as_measured.test_drive(), &before.drive, &study.test_drive(), &after.drive,
                   &study.drive(), &trained.drive},
        {&as_measured.test_load(), &before.load, &study.test_load(), &after.load, &study.load(),
         &trained.load}}) {
    for (std::size_t o = 0; o < problem->outputs().size(); ++o) {
      const std::string name = kOutputNames[problem->outputs()[o]];
      compared.before.push_back(mean_squares(*old_problem, *old_fits, o));
      compared.after.push_back(mean_squares(*problem, *new_fits, o));
      compared.noise.push_back(std::max(learned->runs()[0].least_noise[problem->outputs()[o]],
                                        std::sqrt(mean(mean_squares(*learned, *learned_fits, o)))));
      result.baseline_rms[name] = std::sqrt(mean(compared.before.back()));
      result.extended_rms[name] = std::sqrt(mean(compared.after.back()));
      result.noise[name] = compared.noise.back();
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
  result.gain_ci95 = {gains[kResamples * 25 / 1000], gains[kResamples * 975 / 1000]};
  std::map<std::string, double> rows;
  for (const Trace& trace : traces(study, as_measured, effects)) {
    for (std::size_t k = 0; k < trace.measured.size(); ++k) {
      result.whole_baseline_rms[trace.column] += std::pow(trace.measured[k] - trace.baseline[k], 2);
      result.whole_extended_rms[trace.column] += std::pow(trace.measured[k] - trace.extended[k], 2);
    }
    rows[trace.column] += static_cast<double>(trace.measured.size());
  }
  for (auto* rms : {&result.whole_baseline_rms, &result.whole_extended_rms})
    for (auto& [name, value] : *rms) value = std::sqrt(value / rows[name]);
  return result;
}

}  // namespace crane::diagnosis
