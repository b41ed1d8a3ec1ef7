#include "study/study.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/pendulum.hpp"
#include "replay/standstill.hpp"
#include "study/blocks.hpp"
#include "study/inaccuracies.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Window lengths. The swing needs about one period. In a longer window of a drive that sticks and slips,
/// late or missing slips dominate the residual and hide the error of the friction.
constexpr double kSwingWindow_s = 2, kDriveWindow_s = 1;

Evaluation summed(const Study::Body& body, Fits of_drive, Fits of_load,
                  std::vector<VectorXd> equation_error) {
  Evaluation result;
  result.drive = std::move(of_drive);
  result.load = std::move(of_load);
  result.equation_error = std::move(equation_error);
  result.blocks = blocks_of(body.drive, result.drive);
  for (std::size_t i = 0; i < result.equation_error.size(); ++i)
    result.blocks[body.equation_error.windows()[i]] += loss_of(result.equation_error[i]);
  const Blocks more = blocks_of(body.load, result.load);
  result.drive_blocks = result.blocks.size();
  result.drive_loss = sum(result.blocks);
  result.load_loss = sum(more);
  result.loss = result.drive_loss + result.load_loss;
  result.blocks.insert(result.blocks.end(), more.begin(), more.end());
  return result;
}

double natural_radps(const configuration::Rig& rig) {
  return plant::swing_radps(rig.plant.gravity_mps2, rig.start.position[plant::kHoist]);
}

bool is_null(const Effect& effect) {
  for (std::size_t i = 0; i < effect.values.size(); ++i)
    if (effect.values[i] != effect.candidate->parameters[i].null) return false;
  return true;
}

/// Rms difference between two simulations, as a share of the rms motion, up to which the slopes of one serve
/// as slopes of the other: a direction whose cosine to the true one is sqrt(1 - kLikeBase^2) has all but 4 %
/// of its information.
constexpr double kLikeBase = 0.2;

/// Whether the simulations in windows differ by at most kLikeBase of the motion, in each output.
bool moves_alike(const Problem& problem, const Fits& fits, const Fits& base) {
  for (std::size_t output = 0; output < problem.outputs().size(); ++output) {
    double difference = 0, motion = 0;
    for (std::size_t w = 0; w < fits.size(); ++w) {
      const auto rows = static_cast<Index>(problem.windows()[w].rows);
      const auto first = static_cast<Index>(output) * rows;
      const VectorXd now = fits[w].simulated.segment(first, rows);
      difference += (now - base[w].simulated.segment(first, rows)).squaredNorm();
      motion += (now.array() - now.mean()).matrix().squaredNorm();
    }
    if (!(difference <= kLikeBase * kLikeBase * motion)) return false;
  }
  return true;
}

Fits fit_of(const Problem& problem, const Replays& crane) {
  return problem.empty() ? Fits{} : problem.fit(crane);
}

}  // namespace

double difference_step(const FreeParameter& p, double value) {
  constexpr double kShare = 0.3;
  const double step = kShare * p.step;
  if (value + step <= p.high) return step;
  if (value - step >= p.low) return -step;
  return p.high - value > value - p.low ? p.high - value : p.low - value;
}

Study::Study(const configuration::Rig& rig, const Runs& train, const Runs& test,
             const std::vector<std::string>& excluded, const Accuracy& accuracy)
    : natural_radps_{diagnosis::natural_radps(rig)},
      base_(holding({rig.plant, rig.terms})),
      candidates_(candidates_for(rig, train)),
      train_(train, natural_radps_),
      test_(test, natural_radps_),
      whole_runs_(train, Part::load, kWholeRun, 0) {
  std::erase_if(candidates_, [&](const Candidate& candidate) {
    return std::find(excluded.begin(), excluded.end(), candidate.cause) != excluded.end();
  });
  inaccurate_ = inaccuracies_of(candidates_, rig, accuracy);
  for (const Candidate& candidate : inaccurate_) {
    Effect& none = inaccuracies_.emplace_back(Effect{&candidate, {}});
    for (const FreeParameter& p : candidate.parameters) none.values.push_back(p.null);
  }
}

Study::Body::Body(const Runs& all, double natural_radps)
    : runs(all),
      drive(all, Part::drive, kDriveWindow_s, natural_radps),
      load(all, Part::load, kSwingWindow_s, natural_radps) {}

Effects Study::inaccuracies_beside(const Effects& effects) const {
  Effects others;
  for (const Effect& inaccuracy : inaccuracies_)
    if (std::ranges::none_of(effects, [&](const Effect& effect) {
          return effect.candidate->cause == inaccuracy.candidate->cause &&
                 effect.candidate->axis == inaccuracy.candidate->axis;
        }))
      others.push_back(inaccuracy);
  return others;
}

Effects Study::calibration_beside(const Effects& effects) const {
  Effects beside = inaccuracies_beside(effects);
  std::erase_if(beside, is_null);
  return beside;
}

Crane Study::with(const Effects& effects) const { return crane_with(calibration_beside(effects), effects); }

Crane Study::crane_with(const Effects& inaccuracies, const Effects& effects) const {
  Crane crane = base_;
  for (const Effects* all : {&inaccuracies, &effects})
    for (const Effect& effect : *all) crane.terms.push_back(effect.candidate->setting(effect.values));
  return holding(std::move(crane));
}

void Study::learn_disturbance(const Effects& effects) {
  const Replays crane = replays_of(train_.runs, with(effects));
  for (Problem* train : {&train_.drive, &train_.load})
    if (!train->empty()) train->learn_disturbance(crane);
  train_.equation_error.learn_disturbance(crane);
  evaluate_base();
  uncalibrated_ = nuisance();
  if (!effects.empty()) return;
  calibrate();
}

void Study::calibrate() {
  double least = sum(deviance_of(train_, base_train_));
  Slopes along;
  for (int round = 0; round < kMostNoiseRounds; ++round) {
    const Nuisance before = nuisance();
    Fitted base;
    base.train = base_train_;
    fit_inaccuracies(base, along);
    whiten_with(nuisance_of(base, {}, nuisance()));
    const double gained = least - sum(deviance_of(train_, base_train_));
    if (gained < 0) whiten_with(before);
    if (gained < kWorthARound) break;
    least -= gained;
  }
  slopes_of_inaccuracies_.clear();
  for (std::size_t i = 0; i < along.drive.size(); ++i) slopes_of_inaccuracies_.push_back(along.of_value(i));
}

void Study::whiten_training(const Nuisance& nuisance) {
  inaccuracies_ = nuisance.inaccuracies;
  if (!train_.drive.empty()) train_.drive.whiten_with(nuisance.drive);
  if (!train_.load.empty()) train_.load.whiten_with(nuisance.load);
  train_.equation_error.whiten_with(nuisance.equation_error, replays_of(train_.runs, base_));
}

void Study::whiten_test(const Nuisance& nuisance) {
  if (!test_.drive.empty()) test_.drive.whiten_with(nuisance.drive);
  if (!test_.load.empty()) test_.load.whiten_with(nuisance.load);
  test_.equation_error.whiten_with(nuisance.equation_error, replays_of(test_.runs, base_));
}

void Study::whiten_with(const Nuisance& nuisance) {
  whiten_training(nuisance);
  evaluate_base();
}

Nuisance Study::nuisance() const {
  return {train_.drive.disturbances(), train_.equation_error.disturbances(), train_.load.disturbances(),
          inaccuracies_};
}

void Study::evaluate_base() { base_train_ = evaluated(train_, replays_of(train_.runs, with({}))); }

Evaluation Study::evaluated(const Body& body, const Replays& base) const {
  return summed(body, fit_of(body.drive, base), fit_of(body.load, base), body.equation_error.residuals(base));
}

Evaluation Study::evaluated_again(const Fitted& fitted) const {
  const Replays crane = replays_of(train_.runs, with(fitted.effects));
  const auto again = [&crane](const Problem& problem, const Fits& near) {
    return problem.empty() ? Fits{} : problem.fit_again(crane, near);
  };
  return summed(train_, again(train_.drive, fitted.train.drive), again(train_.load, fitted.train.load),
                train_.equation_error.residuals(crane));
}

Evaluation Study::evaluate(const Body& body, const Effects& effects, const Evaluation& near) const {
  const Replays crane = replays_of(body.runs, with(effects));
  const ShowsIn parts = shown_in(effects);
  return summed(body, parts.drive ? body.drive.fit_near(crane, near.drive) : near.drive,
                parts.load ? body.load.fit_near(crane, near.load) : near.load,
                parts.drive ? body.equation_error.residuals(crane) : near.equation_error);
}

Evaluation Study::train(const Effects& effects) const { return train(effects, base_train_); }
Evaluation Study::train(const Effects& effects, const Evaluation& near) const {
  return evaluate(train_, effects, near);
}

PlainSlope Study::plain_slope(const Replays& crane, const Evaluation& at, double step, ShowsIn parts,
                              const PartVectors& unmoved) const {
  PlainSlope slope;
  if (parts.drive && !train_.drive.empty()) {
    slope.drive = train_.drive.plain_change(crane, at.drive, step);
    slope.equation_error = train_.equation_error.plain_residuals(crane);
    for (std::size_t k = 0; k < unmoved.size(); ++k)
      slope.equation_error[k] = (unmoved[k] - slope.equation_error[k]) / step;
  }
  if (parts.load && !train_.load.empty()) slope.load = train_.load.plain_change(crane, at.load, step);
  return slope;
}

ShowsIn Study::unlike_base(const Effects& effects, const Evaluation& at) const {
  const ShowsIn visible = shown_in(effects);
  return {visible.drive && !moves_alike(train_.drive, at.drive, base_train_.drive),
          visible.load && !moves_alike(train_.load, at.load, base_train_.load)};
}

BlockScores Study::block_scores(const Evaluation& at, const Slopes& slopes, Loss loss) const {
  BlockScores drive = diagnosis::block_scores(train_.drive, at.drive, slopes.drive, loss);
  add_scores(train_.equation_error.windows(), at.equation_error, slopes.equation_error, loss, drive);
  return joined(drive, diagnosis::block_scores(train_.load, at.load, slopes.load, loss));
}

Study::Slopes Study::plain_slopes(const Effects& effects, const Evaluation& at, Slopes known) const {
  const std::size_t first = known.drive.size();
  std::size_t value_index = 0;
  PartVectors unmoved;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const Candidate& candidate = *effects[e].candidate;
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i, ++value_index) {
      if (value_index < first) continue;
      if (candidate.drive && unmoved.empty())
        unmoved = train_.equation_error.plain_residuals(replays_of(train_.runs, with(effects)));
      Effects moved = effects;
      double& value = moved[e].values[i];
      const double step = difference_step(candidate.parameters[i], value);
      value += step;
      known.push_back(plain_slope(replays_of(train_.runs, with(moved)), at, step,
                                  {candidate.drive, candidate.load}, unmoved));
    }
  }
  return known;
}

Study::Slopes Study::whitened(const Slopes& plain, const Evaluation& at) const {
  Slopes result{train_.drive.whitened(plain.drive, at.drive), {}, train_.load.whitened(plain.load, at.load)};
  for (const PartVectors& slope : plain.equation_error)
    result.equation_error.push_back(slope.empty() ? PartVectors{} : train_.equation_error.whitened(slope));
  return result;
}

Study::Slopes Study::slopes(const Effects& effects, const Evaluation& at) const {
  return whitened(plain_slopes(effects, at, {}), at);
}

}  // namespace crane::diagnosis
