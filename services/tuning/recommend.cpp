#include "tuning/recommend.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "crane/experiment/metrics.hpp"
#include "crane/workers/for_each_on_threads.hpp"
#include "tuning/lockstep_crane.hpp"

namespace crane::tuning {
namespace {

constexpr std::size_t kGroupSize = 4;  // number of entries whose margins are computed together
constexpr double kDuration_s = 15;     // duration of a maneuver; a law that needs longer is not recommended

void add(Entry& entry, const experiment::ComparedRun& run) {
  entry.settling_s.push_back(run.metrics ? run.metrics->settling_time_s : std::nullopt);
  if (run.metrics)
    entry.largest_swing_rad = std::max({entry.largest_swing_rad, run.metrics->largest_swing_radial_rad,
                                        run.metrics->largest_swing_tangential_rad});
  if (entry.stopped_because.empty()) entry.stopped_because = run.stopped_because;
}

experiment::ComparedRun run_of(const configuration::Rig& truth, const configuration::Rig& rig,
                               const Candidate& candidate, const experiment::Scenario& maneuver,
                               simulator::Method integrator) {
  const auto changed = with_candidate(rig, candidate);
  return simulate_on(truth, changed, *control::find_controller(candidate.controller), maneuver, integrator);
}

class Recommender {
 public:
  explicit Recommender(const Search& search) : search_{search}, unchecked_{search.rig} {
    // These checks would stop the changed cranes of the margins, which differ from the model.
    unchecked_.limits.model_checks = false;
  }

  /// Tests the entries in the order of their rank until the next entry is slower than the best tested entry.
  Recommendation work() {
    rank();
    const auto settled = counts(result_)[0];
    for (std::size_t first = 0; first < settled; first += kGroupSize) {
      if (result_.winner && mean_s(first) >= predicted_s(*result_.winner)) break;
      test(first, std::min(first + kGroupSize, settled));
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] double mean_s(std::size_t entry) const { return *result_.entries[entry].mean_settling_s; }
  [[nodiscard]] double predicted_s(std::size_t entry) const {
    return result_.entries[entry].predicted->mean_s;
  }

  /// Runs `work` for every maneuver of every case. @return the results by case and maneuver
  template <class Rig, class Of>
  std::vector<experiment::ComparedRun> runs(std::size_t cases, Rig&& truth_of, Of&& candidate_of,
                                            const configuration::Rig& rig) {
    const std::size_t maneuvers = search_.maneuvers.size();
    std::vector<experiment::ComparedRun> results(cases * maneuvers);
    workers::for_each_on_threads(results.size(), search_.processors, [&](std::size_t i) {
      results[i] = run_of(truth_of(i / maneuvers), rig, candidate_of(i / maneuvers),
                          search_.maneuvers[i % maneuvers], search_.integrator);
      results[i].samples.clear();
      const std::scoped_lock lock{mutex_};
      if (search_.progress) search_.progress(++runs_);
    });
    return results;
  }

  void rank() {
    const std::size_t maneuvers = search_.maneuvers.size();
    for (const auto& maneuver : search_.maneuvers) result_.maneuvers.push_back(maneuver.name);
    const auto list = search_.candidates;
    const auto results = runs(
        list.size(), [&](std::size_t) -> const auto& { return search_.truth; },
        [&](std::size_t c) -> const auto& { return list[c]; }, search_.rig);
    for (std::size_t c = 0; c < list.size(); ++c) {
      Entry entry{.candidate = list[c]};
      for (std::size_t m = 0; m < maneuvers; ++m) add(entry, results[c * maneuvers + m]);
      entry.mean_settling_s = mean_of(entry.settling_s);
      result_.entries.push_back(std::move(entry));
    }
    std::ranges::stable_sort(result_.entries, {}, [](const Entry& entry) {
      return entry.mean_settling_s.value_or(std::numeric_limits<double>::infinity());
    });
  }

  void test(std::size_t first, std::size_t last) {
    test_margins(first, last);
    for (std::size_t i = first; i < last; ++i) {
      if (!result_.entries[i].margins->holds()) continue;
      result_.entries[i].predicted = predict(i);
      if (!result_.entries[i].predicted) continue;
      if (!result_.winner || predicted_s(i) < predicted_s(*result_.winner)) result_.winner = i;
    }
  }

  void test_margins(std::size_t first, std::size_t last) {
    const std::size_t cases = MarginRuns::kCases, maneuvers = search_.maneuvers.size();
    const auto results = runs(
        (last - first) * cases, [&](std::size_t i) { return MarginRuns::truth_of(search_.truth, i % cases); },
        [&](std::size_t i) -> const auto& { return result_.entries[first + i / cases].candidate; },
        unchecked_);
    for (std::size_t i = 0; i < last - first; ++i) {
      MarginRuns margins{maneuvers};
      for (std::size_t run = 0; run < margins.size(); ++run)
        margins.take(run, results[i * margins.size() + run]);
      result_.entries[first + i].margins = margins.margins();
    }
  }

  /// @return nothing when the entry does not settle on a drawn rig
  std::optional<Predicted> predict(std::size_t entry) {
    const std::size_t maneuvers = search_.maneuvers.size();
    const double estimate_s = mean_s(entry);
    Predicted predicted{estimate_s, estimate_s, estimate_s};
    const auto results = runs(
        search_.drawn.size(), [&](std::size_t i) -> const auto& { return search_.drawn[i]; },
        [&](std::size_t) -> const auto& { return result_.entries[entry].candidate; }, search_.rig);
    for (std::size_t i = 0; i < search_.drawn.size(); ++i) {
      Entry on_drawn;
      for (std::size_t m = 0; m < maneuvers; ++m) add(on_drawn, results[i * maneuvers + m]);
      const auto mean = mean_of(on_drawn.settling_s);
      if (!mean) return std::nullopt;
      // Running mean over the identified rig (number 1) and the drawn rigs.
      predicted.mean_s += (*mean - predicted.mean_s) / static_cast<double>(i + 2);
      predicted.least_s = std::min(predicted.least_s, *mean);
      predicted.largest_s = std::max(predicted.largest_s, *mean);
    }
    return predicted;
  }

  const Search& search_;
  configuration::Rig unchecked_;
  Recommendation result_;
  std::mutex mutex_;
  std::size_t runs_ = 0;
};

}  // namespace

std::array<std::size_t, 3> counts(const Recommendation& recommendation) {
  std::array<std::size_t, 3> found{};
  for (const auto& entry : recommendation.entries) {
    found[0] += entry.mean_settling_s ? 1 : 0;
    found[1] += entry.margins && entry.margins->holds() ? 1 : 0;
    found[2] += entry.predicted ? 1 : 0;
  }
  return found;
}

Recommendation recommend(const Search& search) { return Recommender{search}.work(); }

Entry evaluate(const configuration::Rig& truth, const configuration::Rig& rig, const Candidate& candidate,
               std::span<const experiment::Scenario> maneuvers, simulator::Method integrator) {
  Entry entry{.candidate = candidate};
  for (const auto& maneuver : maneuvers) add(entry, run_of(truth, rig, candidate, maneuver, integrator));
  entry.mean_settling_s = mean_of(entry.settling_s);
  return entry;
}

std::vector<experiment::Scenario> maneuvers_for(const configuration::Rig& rig,
                                                std::span<const std::filesystem::path> files) {
  std::vector<experiment::Scenario> possible;
  for (const auto& file : files) {
    auto scenario = experiment::load_scenario(file);
    scenario.start[plant::kHoist].reset();
    scenario.duration_s = kDuration_s;
    const auto fits = [&](std::size_t axis, double position) {
      const auto& drive = rig.drives[axis];
      return drive.present && position >= drive.low_limit + drive.soft_margin &&
             position <= drive.high_limit - drive.soft_margin;
    };
    bool all_fit = true;
    for (const auto& move : scenario.moves)
      for (std::size_t axis = 0; axis < plant::kAxes; ++axis)
        if (move.target[axis]) all_fit = all_fit && fits(axis, *move.target[axis]);
    for (std::size_t axis = 0; axis < plant::kAxes; ++axis) {
      if (!rig.drives[axis].present) scenario.start[axis].reset();
      if (scenario.start[axis]) all_fit = all_fit && fits(axis, *scenario.start[axis]);
    }
    if (all_fit) possible.push_back(std::move(scenario));
  }
  return possible;
}

}  // namespace crane::tuning
