#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "replay/standstill.hpp"
#include "robust.hpp"
#include "rules.hpp"
#include "search/block_votes.hpp"
#include "search/compare.hpp"
#include "verdict/missing_force.hpp"
#include "verdict/residual_patterns.hpp"
#include "verdict/sentence.hpp"

namespace crane::diagnosis {
namespace {

/// Mean loss over its expectation: 1 if noise and disturbance are as learnt.
double mean_loss(const Problem& problem, const Fits& fits) {
  double sum = 0, count = 0;
  for (std::size_t w = 0; w < fits.size(); ++w) {
    sum += loss_of(fits[w].residual);
    count += static_cast<double>(problem.measured_rows(problem.windows()[w]));
  }
  return count > 0 ? sum / (kMeanLoss * count) : 0;
}

std::string described(const SwingPattern& pattern) {
  return (std::ostringstream{} << std::setprecision(2) << pattern.name << " (" << pattern.rms_rad
                               << " rad rms in windows)")
      .str();
}

std::string described(const ShortForce& force, const Runs& runs) {
  const Run& run = runs[force.run].run;
  return (std::ostringstream{} << std::setprecision(2) << "a force on the load of "
                               << 100 * std::abs(force.share_of_weight) << " % of its weight for about "
                               << force.duration_s << " s in the direction of " << kOutputNames[force.output]
                               << " (" << run.name << " at " << std::fixed << std::setprecision(1)
                               << run.start_s + force.from_s << " s)")
      .str();
}

class Judgement {
 public:
  Judgement(const WhitenedData& data, const Hypotheses& hypotheses, const Fitted& with_intervals,
            const StatedAccuracy& accuracy, const std::vector<LosingEncoder>& losing, std::uint64_t seed)
      : data_(data),
        all_(hypotheses),
        best_(hypotheses.best),
        accuracy_(accuracy),
        losing_(losing),
        seed_(seed),
        within_(accuracy.contains_each(data.study(), with_intervals)) {
    if (std::ranges::find(within_, false) == within_.end()) test_drives();
    for (std::size_t i = 0; i < within_.size(); ++i)
      if (!within_[i]) causes_.push_back(best_.effects[i]);
    result_.ranking = hypotheses.ranking;
    result_.detection_p_value = hypotheses.detection_p_value;
  }

  Judged run() {
    if (has_unexplained_residual())
      result_.verdict = Verdict::unknown;
    else if (causes_.empty())
      result_.verdict = Verdict::none;
    else
      decide_by_vote();
    report_causes();
    result_.sentence = sentence_of(result_);
    return {std::move(result_), std::move(rival_), std::move(within_)};
  }

 private:
  /// Tests the errors of the drives of the calibrated base model. If noise and accuracy do not explain the
  /// error of a drive, every accepted candidate on this drive is a cause, also one that changes the mean
  /// error little. Exception: candidates with a stated accuracy.
  void test_drives() {
    Crane base = data_.study().base();
    for (const Effect& inaccuracy : all_.base.nuisance.inaccuracies)
      base.terms.push_back(inaccuracy.candidate->setting(inaccuracy.values));
    drive_error_ = accuracy_.drive_error_beyond(data_, holding(std::move(base)));
    if (!drive_error_) return;
    for (std::size_t i = 0; i < within_.size(); ++i) {
      const Candidate& candidate = *best_.effects[i].candidate;
      if (candidate.acts_on(drive_error_->output) && !accuracy_.is_stated(candidate)) within_[i] = false;
    }
  }

  /// True if the residual is not explained; adds the variables on which it depends.
  bool has_unexplained_residual() {
    const double load = mean_loss(data_.load(), best_.train.load),
                 drives = mean_loss(data_.drive(), best_.train.drive);
    ResidualPattern& remainder = result_.remainder;
    if (std::max(load, drives) > rules::kWorstLoss) {
      remainder.predictable_fraction = 1 - rules::kWorstLoss / std::max(load, drives);
      remainder.from.push_back(std::string{"the residual of the "} +
                               (load > rules::kWorstLoss ? "swing" : "drives") +
                               " is larger than its noise model explains");
      return true;
    }
    if (const std::string lacking = not_followed(); !lacking.empty()) {
      remainder.from.push_back(lacking);
      return true;
    }
    const auto [patterns, forces] =
        swing_residual(data_, best_, !causes_.empty(), accuracy_.permitted_share_of_swing(), seed_);
    for (std::size_t i = 0; i < std::min<std::size_t>(3, patterns.size()); ++i)
      remainder.from.push_back(described(patterns[i]));
    if (!patterns.empty()) {
      remainder.predictable_fraction = patterns[0].fraction;
      return true;
    }
    // Short forces do not invalidate a cause that was found.
    for (const ShortForce& force : forces) remainder.from.push_back(described(force, data_.runs()));
    if (causes_.empty() && !forces.empty()) return true;
    std::vector<Pattern> left = residual_patterns(data_, all_, losing_, seed_);
    std::erase_if(left, [&](const Pattern& pattern) { return accuracy_.contains(pattern.what); });
    if (left.empty()) return false;
    remainder.predictable_fraction = left[0].what.fraction;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, left.size()); ++i)
      remainder.from.push_back(left[i].what.variable);
    return std::any_of(left.begin(), left.end(),
                       [&](const Pattern& pattern) { return counts_as_pattern(pattern, best_.effects); });
  }

  /// Tests for a swing whose missing force exceeds a credible disturbance, and for a drive whose error
  /// the noise and the accuracy of the rig file do not explain. @return description of the missing part;
  /// empty: nothing is missing
  [[nodiscard]] std::string not_followed() const {
    const std::optional<SignificantDriveError> error =
        causes_.empty() ? drive_error_
                        : accuracy_.drive_error_beyond(data_, holding(data_.with(best_.effects)));
    return error ? error->description : swing_not_followed();
  }

  [[nodiscard]] std::string swing_not_followed() const {
    if (data_.load().empty()) return "";
    const Problem& plain = data_.study().train().load;
    const Fits fits = plain.fit(replays_of(plain.runs(), data_.with(best_.effects)));
    const std::vector<Output>& outputs = plain.outputs();
    for (std::size_t output = 0; output < outputs.size(); ++output) {
      // The learnt noise alone may contain an error of the model that changes quickly.
      const double noise = std::min(data_.load().disturbances()[output].noise, measured_noise(plain, output));
      if (share_not_followed(plain, fits, output, noise) <= rules::kNotFollowed) continue;
      const double force = missing_force(plain, fits, output, data_.study().natural_radps(), noise);
      if (force > rules::kCredibleForce)
        return (std::ostringstream{} << std::setprecision(2) << "the simulation of "
                                     << kOutputNames[outputs[output]] << " lacks a force on the load of "
                                     << 100 * force << " % of its weight, rms")
            .str();
    }
    return "";
  }

  /// Whether a hypothesis lacks a cause of the best one. Otherwise it differs by effects within the accuracy
  /// of the rig file.
  [[nodiscard]] bool lacks_a_cause(const Fitted& fitted) const {
    return std::ranges::any_of(causes_,
                               [&](const Effect& cause) { return !has(fitted.effects, cause.candidate); });
  }

  /// Vote among the best hypothesis and the rivals of the same size that explain an error. A hypothesis that
  /// the held-out data alone do not confirm may still be the cause.
  void decide_by_vote() {
    std::vector<const Fitted*> equals;
    for (const Fitted& fitted : all_.all)
      if (fitted.effects.size() == best_.effects.size() && lacks_a_cause(fitted) &&
          !differs_by_rarer_causes(fitted.effects, best_.effects) &&
          likelier_in_resamples(fitted, all_.base, seed_))
        equals.push_back(&fitted);
    const std::vector<double> picked = shares_of_votes(best_, equals, all_.base, seed_);
    double left = 1;
    for (std::size_t r = 0; r < equals.size(); ++r) {
      left -= picked[r];
      for (const Effect& effect : equals[r]->effects) frequency_[effect.candidate] += picked[r];
    }
    for (const Effect& effect : best_.effects) frequency_[effect.candidate] += left;
    bool clear = true, known = true;
    for (const Effect& effect : causes_) {
      clear = clear && frequency_[effect.candidate] >= rules::kClearWin;
      known = known && effect.candidate->changes_known_parameter;
    }
    std::vector<const Candidate*> rivals;
    for (const auto& [candidate, share] : frequency_)
      if (share >= rules::kRunnerUp && !has(best_.effects, candidate)) rivals.push_back(candidate);
    result_.verdict = !clear && !rivals.empty() ? Verdict::ambiguous
                      : known                   ? Verdict::parameter
                                                : Verdict::named;
    if (result_.verdict != Verdict::ambiguous) return;
    std::sort(rivals.begin(), rivals.end(),
              [&](const Candidate* a, const Candidate* b) { return frequency_[a] > frequency_[b]; });
    auto& names = result_.ambiguous_with;
    for (const Candidate* rival : rivals)
      if (std::find(names.begin(), names.end(), rival->cause) == names.end()) names.push_back(rival->cause);
    double most = 0;
    for (std::size_t r = 0; r < equals.size(); ++r)
      if (has(equals[r]->effects, rivals[0]) && picked[r] > most)
        most = picked[r], rival_ = equals[r]->effects;
  }

  void report_causes() {
    for (std::size_t i = 0; i < best_.effects.size(); ++i) {
      const Effect& effect = best_.effects[i];
      Cause cause{effect.candidate->cause, effect.candidate->axis, {}, 1, 0};
      for (const Ranked& ranked : result_.ranking)
        if (ranked.label == effect.candidate->label()) cause.p_value = ranked.p_value;
      const auto found = frequency_.find(effect.candidate);
      cause.resampling_frequency = found == frequency_.end() ? 0 : found->second;
      (within_[i] ? result_.within_accuracy : result_.causes).push_back(cause);
    }
    for (Ranked& ranked : result_.ranking)
      for (const auto& [candidate, share] : frequency_)
        if (candidate->label() == ranked.label) ranked.resampling_frequency = share;
    std::stable_sort(result_.ranking.begin(), result_.ranking.end(),
                     [](const Ranked& a, const Ranked& b) { return a.train_gain > b.train_gain; });
  }

  const WhitenedData& data_;
  const Hypotheses& all_;
  const Fitted& best_;
  const StatedAccuracy& accuracy_;
  const std::vector<LosingEncoder>& losing_;
  std::uint64_t seed_;
  std::vector<bool> within_;  ///< by effect of `best_`: within the accuracy of the rig file
  std::optional<SignificantDriveError> drive_error_;  ///< of the base model, if no effect is a cause
  Effects causes_;                                    ///< effects of `best_` beyond the accuracy
  std::map<const Candidate*, double> frequency_;
  Effects rival_;
  Diagnosis result_;
};

}  // namespace

void make_unknown(Diagnosis& diagnosis, const std::string& why) {
  diagnosis.verdict = Verdict::unknown;
  diagnosis.ambiguous_with.clear();
  diagnosis.remainder.from.insert(diagnosis.remainder.from.begin(), why);
  diagnosis.sentence = sentence_of(diagnosis);
}

Judged judge(const WhitenedData& data, const Hypotheses& hypotheses, const Fitted& best,
             const StatedAccuracy& accuracy, const std::vector<LosingEncoder>& losing, std::uint64_t seed) {
  return Judgement(data, hypotheses, best, accuracy, losing, seed).run();
}

}  // namespace crane::diagnosis
