#include "crane/innovations/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "crane/innovations/rules.hpp"
#include "leftover/leftover.hpp"
#include "sanity/held_out.hpp"

namespace crane::innovations {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Verdict;

std::vector<diagnosis::Estimate> as_diagnosis(const std::vector<Estimate>& estimates) {
  std::vector<diagnosis::Estimate> all;
  for (const Estimate& e : estimates) all.push_back({e.name, e.unit, e.value, e.std_dev});
  return all;
}

std::vector<diagnosis::Cause> causes_of(const Problem& problem, const SearchResult& found) {
  const Sandwich s = sandwich(problem, found.model.fit, found.model.theta());
  const auto theta = found.model.theta();
  std::vector<diagnosis::Cause> causes;
  for (std::size_t k = 0; k < found.model.causes.size(); ++k) {
    const Candidate& c = found.model.causes[k];
    const auto n = static_cast<Eigen::Index>(c.theta.size());
    Eigen::MatrixXd own(n, n);
    const auto place = [&](Index i) { return std::find(theta.begin(), theta.end(), i) - theta.begin(); };
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = 0; b < n; ++b)
        own(a, b) = s.covariance(place(c.theta[static_cast<std::size_t>(a)]),
                                 place(c.theta[static_cast<std::size_t>(b)]));
    diagnosis::Cause cause{setting_of(c, problem, found.model.fit.at.values).name,
                           c.axis,
                           {},
                           rule::kDetection.value,
                           found.frequency[k]};
    cause.parameters = as_diagnosis(estimates_of(c, problem, found.model.fit.at.values, own));
    causes.push_back(std::move(cause));
  }
  return causes;
}

/// Whether what is left is beyond luck, large beside the unknown force, and large beside what is named.
bool matters(const Leftover& left, double named_gain) {
  const LeftoverGroup* strongest = left.strongest();
  return strongest != nullptr && strongest->gain > 0 && left.p_value <= rule::kLeftoverLevel.value &&
         strongest->share >= rule::kLeftoverShare.value &&
         strongest->gain > rule::kLeftoverBeside.value * named_gain;
}

Verdict verdict_of(const SearchResult& found, const Leftover& left, const HeldOutJudgement& held) {
  const auto& causes = found.model.causes;
  if (matters(left, found.model.value() - found.base.value())) return Verdict::unknown;
  if (causes.empty()) return Verdict::none;
  if (!held.refused.empty()) return Verdict::unknown;
  if (!found.rivals.empty()) return Verdict::ambiguous;
  const bool known =
      std::all_of(causes.begin(), causes.end(), [](const Candidate& c) { return c.known_parameter; });
  return known ? Verdict::parameter : Verdict::named;
}

std::string list_of(const std::vector<diagnosis::Cause>& causes) {
  std::string text;
  for (const auto& c : causes)
    text += (text.empty() ? "" : ", ") + c.name + (c.axis.empty() ? "" : " (" + c.axis + ")");
  return text;
}

std::string sentence_of(const Result& r, const Leftover& left) {
  const Diagnosis& d = r.diagnosis;
  std::ostringstream text;
  text.precision(3);
  switch (d.verdict) {
    case Verdict::none:
      text << "these data show nothing wrong with the model";
      break;
    case Verdict::named:
      text << "the model lacks " << list_of(d.causes);
      break;
    case Verdict::parameter:
      text << "a quantity of the rig file has another value: " << list_of(d.causes);
      break;
    case Verdict::ambiguous:
      text << list_of(d.causes) << " explains the data; so does";
      for (const auto& name : d.ambiguous_with) text << ' ' << name;
      break;
    case Verdict::unknown:
      text << "something is wrong that no cause of the library explains";
      for (const std::string& why : r.refused) text << "; " << why;
      if (const auto* g = left.strongest(); g != nullptr && r.refused.empty())
        text << "; what is missing is a " << g->name << " of " << g->force_rms << " rms";
      break;
  }
  return text.str();
}

void describe(const Problem& problem, const SearchResult& found, const Leftover& left, Result& r) {
  Diagnosis& d = r.diagnosis;
  auto causes = causes_of(problem, found);
  if (d.verdict == Verdict::unknown)
    d.attempted = std::move(causes);
  else
    d.causes = std::move(causes);
  if (d.verdict == Verdict::ambiguous) d.ambiguous_with = found.rivals;
  for (const Candidate& c : found.model.causes)
    if (c.term)
      d.extension.push_back(setting_of(c, problem, found.model.fit.at.values));
    else
      d.notes.push_back(c.label() + ": no term of the simulator; extended.toml lacks it");
  for (const Tried& t : found.tried)
    d.ranking.push_back({t.label, as_diagnosis(t.estimates), t.gain, 0, 1, 0});
  for (const LeftoverGroup& g : left.groups) r.leftover.push_back({g.name, g.gain, g.share, g.force_rms});
  r.leftover_p_value = left.p_value;
  if (const auto* g = left.strongest();
      g != nullptr && g->gain > 0 && left.p_value <= rule::kLeftoverLevel.value) {
    d.remainder.predictable_fraction = g->share;
    d.remainder.from = {g->name};
  }
  for (const auto& name : problem.nominal.ignored)
    d.notes.push_back("term " + name + " of the rig file is not known to this engine and left out");
  if (problem.between == Between::straight)
    d.notes.push_back("the command changes between its rows: straight from row to row is likelier than held");
  d.sentence = sentence_of(r, left);
}

}  // namespace

Result diagnose(const runtime::Rig& rig, std::vector<Run> train, std::vector<Run> test,
                const diagnosis::Request& request) {
  const auto begin = std::chrono::steady_clock::now();
  if (train.empty() || test.empty()) throw DataProblem("no run to learn from, or none held out");
  Problem problem{rig, std::move(train)};
  if (const std::size_t size = problem.layout(problem.base).size; !has_filter(size))
    throw DataProblem(rig.name + ": a state of " + std::to_string(size) +
                      " numbers: this engine takes one or two coordinates");
  SearchOptions options{request.most_effects, request.seed, request.excluded, request.progress};
  const SearchResult found = search(problem, options);
  request.progress(0.9, "what is left");
  const Leftover left = leftover(problem, found.model.fit.at, request.seed);
  request.progress(0.95, "held-out runs");
  const Problem held = problem.with_runs(std::move(test));
  HeldOutJudgement judged = judge_held_out(problem, held, found.base, found.model, request.seed);
  Result result;
  result.diagnosis.verdict = verdict_of(found, left, judged);
  result.diagnosis.held_out = judged.errors;
  result.held_out_nats = judged.nats, result.held_out_nats_ci95 = judged.nats_ci95;
  result.refused = judged.refused;
  describe(problem, found, left, result);
  result.diagnosis.detection_p_value = found.model.causes.empty() ? 1 : rule::kDetection.value;
  result.diagnosis.runtime_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  request.progress(1, "done");
  return result;
}

}  // namespace crane::innovations
