#include "verdict/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <numbers>
#include <sstream>

#include "replay/standstill.hpp"
#include "robust.hpp"
#include "rules.hpp"
#include "search/compare.hpp"
#include "verdict/leftovers.hpp"
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

/// Rms residual of an output in windows over the rms motion in the windows; 0 if the output hardly moves.
double share_not_followed(const Problem& problem, const Fits& fits, std::size_t output) {
  double moved = 0, count = 0;
  for (const Window& window : problem.windows()) {
    const Eigen::VectorXd measured = problem.measured_values(window, output);
    moved += (measured.array() - measured.mean()).matrix().squaredNorm();
    count += static_cast<double>(measured.size());
  }
  return moved > rules::kSwings * rules::kSwings * count
             ? std::sqrt(sum(problem.squares_left(fits, output)) / moved)
             : 0;
}

/// Rms of the missing force on the load, as a share of the weight: F / m g = r'' / w^2 + r with the residual
/// r and the natural frequency w. The second difference spans an eighth of a period, so that counts and noise
/// of the sensor have little effect.
double lacking_force(const Problem& problem, const Fits& fits, std::size_t output, double natural_radps) {
  constexpr double kSpan_periods = 1.0 / 8;
  double squares = 0, count = 0;
  for (std::size_t w = 0; w < fits.size(); ++w) {
    const Window& window = problem.windows()[w];
    const double period_s = problem.runs()[window.run].run.period_s;
    const auto rows = static_cast<Eigen::Index>(window.rows);
    const auto span = static_cast<Eigen::Index>(
        std::lround(kSpan_periods * 2 * std::numbers::pi / natural_radps / period_s));
    if (span < 1 || rows <= 2 * span) continue;
    const Eigen::VectorXd left = (problem.measured(window) - fits[w].simulated)
                                     .segment(static_cast<Eigen::Index>(output) * rows, rows);
    const double scale = 1 / std::pow(static_cast<double>(span) * period_s * natural_radps, 2);
    const Run& run = problem.runs()[window.run].run;
    const auto is_measured = [&](Eigen::Index k) {
      return run.is_measured(problem.outputs()[output], window.first + static_cast<std::size_t>(k));
    };
    for (Eigen::Index k = span; k + span < rows; ++k) {
      if (!is_measured(k - span) || !is_measured(k) || !is_measured(k + span)) continue;
      const double force = scale * (left[k + span] - 2 * left[k] + left[k - span]) + left[k];
      squares += force * force;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

class Judgement {
 public:
  Judgement(const Study& study, const Hypotheses& hypotheses, const StatedAccuracy& accuracy,
            const std::vector<LosingEncoder>& losing, std::uint64_t seed)
      : study_(study),
        all_(hypotheses),
        best_(hypotheses.best),
        accuracy_(accuracy),
        losing_(losing),
        seed_(seed),
        within_(accuracy.contains_each(study, best_.effects)) {
    if (std::ranges::find(within_, false) == within_.end()) test_drives();
    for (std::size_t i = 0; i < within_.size(); ++i)
      if (!within_[i]) causes_.push_back(best_.effects[i]);
    result_.ranking = hypotheses.ranking;
    result_.detection_p_value = hypotheses.detection_p_value;
  }

  Judged run() {
    const bool doubted = doubt();
    if (doubted)
      result_.verdict = Verdict::unknown;
    else if (causes_.empty())
      result_.verdict = Verdict::none;
    else
      name();
    report_causes();
    result_.sentence = sentence_of(result_);
    return {std::move(result_), std::move(rival_), std::move(within_)};
  }

 private:
  /// Tests the errors of the drives of the calibrated base model. An effect on a drive whose error noise and
  /// accuracy do not explain is a cause, however little it changes the mean error, unless the accuracy of its
  /// quantity is stated.
  void test_drives() {
    Crane base = study_.base();
    for (const Effect& inaccuracy : all_.base.nuisance.inaccuracies)
      base.terms.push_back(inaccuracy.candidate->setting(inaccuracy.values));
    drive_error_ = accuracy_.drive_error_beyond(study_, holding(std::move(base)));
    if (!drive_error_) return;
    for (std::size_t i = 0; i < within_.size(); ++i) {
      const Candidate& candidate = *best_.effects[i].candidate;
      if (candidate.acts_on(drive_error_->output) && !accuracy_.is_stated(candidate)) within_[i] = false;
    }
  }

  /// True if the residual is not explained; adds the variables on which it depends.
  bool doubt() {
    const double load = mean_loss(study_.load(), best_.train.load),
                 drives = mean_loss(study_.drive(), best_.train.drive);
    Remainder& remainder = result_.remainder;
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
    std::vector<Pattern> left = patterns_left(study_, all_, losing_, seed_);
    std::erase_if(left, [&](const Pattern& pattern) { return accuracy_.contains(pattern.what); });
    if (left.empty()) return false;
    remainder.predictable_fraction = left[0].what.fraction;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, left.size()); ++i)
      remainder.from.push_back(left[i].what.variable);
    return std::any_of(left.begin(), left.end(),
                       [&](const Pattern& pattern) { return pattern_share(pattern, best_.effects); });
  }

  /// Tests for a swing whose missing force exceeds a credible disturbance, and for a drive whose error
  /// the noise and the accuracy of the rig file do not explain. @return description of the missing part;
  /// empty: nothing is missing
  [[nodiscard]] std::string not_followed() const {
    const std::string drive = causes_.empty() && drive_error_ ? drive_error_->description : "";
    return drive.empty() ? swing_not_followed() : drive;
  }

  [[nodiscard]] std::string swing_not_followed() const {
    if (study_.load().empty()) return "";
    const Problem plain = study_.load().plain();
    const Fits fits = plain.fit(replays_of(plain.runs(), study_.with(best_.effects)));
    const std::vector<Output>& outputs = plain.outputs();
    for (std::size_t output = 0; output < outputs.size(); ++output) {
      if (share_not_followed(plain, fits, output) <= rules::kNotFollowed) continue;
      const double force = lacking_force(plain, fits, output, study_.natural_radps());
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
  void name() {
    std::vector<const Fitted*> equals;
    for (const Fitted& fitted : all_.all)
      if (fitted.effects.size() == best_.effects.size() && lacks_a_cause(fitted) &&
          possible(fitted, all_.base, seed_))
        equals.push_back(&fitted);
    const std::vector<double> picked = frequencies(best_, equals, all_.base, seed_);
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

  const Study& study_;
  const Hypotheses& all_;
  const Fitted& best_;
  const StatedAccuracy& accuracy_;
  const std::vector<LosingEncoder>& losing_;
  std::uint64_t seed_;
  std::vector<bool> within_;  ///< by effect of `best_`: within the accuracy of the rig file
  std::optional<SignificantDriveError> drive_error_;  ///< of the base model, if no effect is a cause
  Effects causes_;                                    ///< the other effects of `best_`
  std::map<const Candidate*, double> frequency_;
  Effects rival_;
  Diagnosis result_;
};

}  // namespace

void doubt(Diagnosis& diagnosis, const std::string& why) {
  diagnosis.verdict = Verdict::unknown;
  diagnosis.ambiguous_with.clear();
  diagnosis.remainder.from.insert(diagnosis.remainder.from.begin(), why);
  diagnosis.sentence = sentence_of(diagnosis);
}

Judged judge(const Study& study, const Hypotheses& hypotheses, const StatedAccuracy& accuracy,
             const std::vector<LosingEncoder>& losing, std::uint64_t seed) {
  return Judgement(study, hypotheses, accuracy, losing, seed).run();
}

}  // namespace crane::diagnosis
