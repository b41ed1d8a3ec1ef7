#include "select/search.hpp"

#include <algorithm>
#include <cmath>

#include "crane/innovations/rules.hpp"

namespace crane::innovations {
namespace {

constexpr std::size_t kFirstContenders = 8, kLaterContenders = 6, kFinalists = 3;
/// Nats that a start must promise to be worth a fit.
constexpr double kWorthAFit = 3;

std::vector<Index> joined(std::vector<Index> a, const std::vector<Index>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class Search {
 public:
  Search(Problem& problem, const SearchOptions& options) : problem_(problem), options_(options) {}

  SearchResult run() {
    choose_between();
    library_ = candidates_for(problem_);
    std::erase_if(library_, [&](const Candidate& c) {
      return std::find(options_.excluded.begin(), options_.excluded.end(), c.name) != options_.excluded.end();
    });
    judge(result_.base);
    result_.model = result_.base;
    base_error_ = open_loop(problem_, result_.base.fit.at, rule::kWindow.value).rms();
    for (std::size_t stage = 0; stage < options_.most_effects; ++stage)
      if (!extend(stage)) break;
    return std::move(result_);
  }

 private:
  void choose_between() {
    progress(0.05, "noise of the base model");
    Fit& fit = result_.base.fit;
    fit = ascend(problem_, {problem_.base, {}}, problem_.noise(), {14, 0.3});
    fit = fit_starts(problem_, std::move(fit), 6);
    const Layout layout = layout_of(problem_.rig, problem_.runs, false);
    if (!layout.volts[0] && !layout.volts[1]) return;
    problem_.between = Between::straight;
    Fit straight = ascend(problem_, fit.at, problem_.noise(), {8, 0.3});
    if (straight.value > fit.value + 20)
      fit = std::move(straight);
    else
      problem_.between = Between::held;
  }

  void judge(Model& model) const {
    const auto held = cross_validated(problem_, model.fit, joined(model.theta(), problem_.noise()));
    model.by_block = block_sums(blocks_of(problem_), held);
  }

  void progress(double share, const std::string& what) const { options_.progress(share, what); }

  /// Values, then noise, then both: one valley at a time.
  Model fitted(const Screened& s, int rounds) const {
    Model m = result_.model;
    m.causes.push_back(*s.candidate);
    const auto noise = problem_.noise();
    m.fit = ascend(problem_, s.start, m.theta(), {2, 1});
    m.fit = fit_starts(problem_, std::move(m.fit), 3);
    m.fit = ascend(problem_, m.fit.at, noise, {3, 1});
    m.fit = ascend(problem_, m.fit.at, joined(m.theta(), noise), {rounds, 0.5});
    return m;
  }
  void converge(Model& m) const {
    m.fit = fit_starts(problem_, std::move(m.fit), 4);
    m.fit = ascend(problem_, m.fit.at, joined(m.theta(), problem_.noise()), {10, 0.2});
  }

  std::vector<Model> contenders(std::size_t stage) const {
    std::vector<Candidate> left;
    for (const Candidate& c : library_)
      if (!result_.model.has(c)) left.push_back(c);
    const auto screened = screen(problem_, result_.model.fit, left);
    std::vector<Model> models;
    const std::size_t most = stage == 0 ? kFirstContenders : kLaterContenders;
    for (const Screened& s : screened) {
      if (models.size() >= most || s.rank() < kWorthAFit) break;
      progress(0.1 + 0.25 * static_cast<double>(stage), "fit of " + s.candidate->label());
      Model m = fitted(s, stage == 0 ? 4 : 3);
      if (m.fit.usable()) models.push_back(std::move(m));
    }
    const auto by_likelihood = [](const Model& a, const Model& b) { return a.fit.value > b.fit.value; };
    std::stable_sort(models.begin(), models.end(), by_likelihood);
    for (std::size_t i = 0; i < std::min(kFinalists, models.size()); ++i) converge(models[i]);
    std::stable_sort(models.begin(), models.end(), by_likelihood);
    models.resize(std::min(models.size(), kFinalists + 1));
    for (Model& m : models) judge(m);
    std::stable_sort(models.begin(), models.end(),
                     [](const Model& a, const Model& b) { return a.value() > b.value(); });
    return models;
  }

  /// Largest share of the base's open-loop error that a further cause removes in a column.
  double effect(const Model& more, const std::array<double, kChannels>& before) const {
    const auto after = open_loop(problem_, more.fit.at, rule::kWindow.value).rms();
    double most = 0;
    for (std::size_t c = 0; c < kChannels; ++c)
      if (before[c] > 0) most = std::max(most, 1 - after[c] / before[c]);
    return most;
  }

  bool extend(std::size_t stage) {
    progress(0.1 + 0.25 * static_cast<double>(stage), "scores of the candidates");
    std::vector<Model> models = contenders(stage);
    if (models.empty()) return false;
    Model& best = models.front();
    const auto d = difference(best.by_block, result_.model.by_block);
    const double level = rule::kDetection.value / static_cast<double>(library_.size());
    const double lower = resampled_sum(d, level, options_.seed), gain = sum(d);
    const auto before =
        stage == 0 ? base_error_ : open_loop(problem_, result_.model.fit.at, rule::kWindow.value).rms();
    const double removed = effect(best, before);
    for (const Model& m : models) {
      const double own = m.value() - result_.model.value();
      const auto s = sandwich(problem_, m.fit, m.causes.back().theta);
      result_.tried.push_back({label_of(m), own, &m == &best ? lower : 0, &m == &best ? removed : 0,
                               estimates_of(m.causes.back(), problem_, m.fit.at.values, s.covariance)});
    }
    const double so_far = result_.model.value() - result_.base.value();
    if (lower <= 0 || removed < rule::kLeastEffect.value || gain < rule::kLeastSecond.value * so_far)
      return false;
    std::vector<std::string> rivals;
    double frequency = 1;
    for (std::size_t i = 1; i < models.size(); ++i) {
      const auto over = difference(best.by_block, models[i].by_block);
      frequency = std::min(frequency, share_positive(over, options_.seed));
      const bool explains = models[i].value() > result_.model.value() + 0.5 * gain;
      if (explains && resampled_sum(over, rule::kRivalLevel.value, options_.seed) <= 0)
        rivals.push_back(models[i].causes.back().name);
    }
    result_.model = pruned(best);
    result_.rivals = std::move(rivals);
    result_.frequency.push_back(frequency);
    result_.frequency.resize(result_.model.causes.size(), frequency);
    return true;
  }

  static std::string label_of(const Model& m) {
    std::string label;
    for (const Candidate& c : m.causes) label += (label.empty() ? "" : " + ") + c.label();
    return label;
  }

  /// Without the causes before the last one that no longer matter.
  Model pruned(Model m) const {
    for (std::size_t k = 0; k + 1 < m.causes.size();) {
      Model less = m;
      less.causes.erase(less.causes.begin() + static_cast<std::ptrdiff_t>(k));
      for (const Index i : m.causes[k].theta) {
        const auto kept = less.theta();
        if (std::find(kept.begin(), kept.end(), i) == kept.end()) less.fit.at.values[i] = problem_.base[i];
      }
      less.fit = ascend(problem_, less.fit.at, joined(less.theta(), problem_.noise()), {8, 0.5});
      if (!less.fit.usable()) {
        ++k;
        continue;
      }
      judge(less);
      if (m.value() - less.value() < rule::kLeastSecond.value * (m.value() - result_.base.value()))
        m = std::move(less);
      else
        ++k;
    }
    return m;
  }

  Problem& problem_;
  const SearchOptions& options_;
  std::vector<Candidate> library_;
  SearchResult result_;
  std::array<double, kChannels> base_error_{};
};

}  // namespace

std::vector<Index> Model::theta() const {
  std::vector<Index> all;
  for (const Candidate& c : causes)
    for (const Index i : c.theta)
      if (std::find(all.begin(), all.end(), i) == all.end()) all.push_back(i);
  return all;
}

bool Model::has(const Candidate& c) const {
  return std::any_of(causes.begin(), causes.end(), [&](const Candidate& own) {
    return std::any_of(own.theta.begin(), own.theta.end(), [&](Index i) {
      return std::find(c.theta.begin(), c.theta.end(), i) != c.theta.end();
    });
  });
}

SearchResult search(Problem& problem, const SearchOptions& options) { return Search{problem, options}.run(); }

}  // namespace crane::innovations
