#include "study/study.hpp"

#include <algorithm>
#include <cmath>

#include "study/blocks.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::VectorXd;

/// Long enough for a swing. Where a drive sticks and slips, an error of its friction makes slips that come
/// too late or not at all: in longer windows these, not the error, make the residual.
constexpr double kSwingWindow_s = 2, kDriveWindow_s = 1;

Evaluation summed(const Problem& drive, const Problem& load, Fits of_drive, Fits of_load) {
  Evaluation result;
  result.drive = std::move(of_drive);
  result.load = std::move(of_load);
  result.blocks = blocks_of(drive, result.drive);
  const Blocks more = blocks_of(load, result.load);
  result.drive_blocks = result.blocks.size();
  result.drive_loss = sum(result.blocks);
  result.load_loss = sum(more);
  result.loss = result.drive_loss + result.load_loss;
  result.blocks.insert(result.blocks.end(), more.begin(), more.end());
  return result;
}

Fits fit_of(const Problem& problem, const Crane& crane) {
  return problem.empty() ? Fits{} : problem.fit(crane);
}

}  // namespace

Study::Study(const runtime::Rig& rig, const Runs& train, const Runs& test,
             const std::vector<std::string>& excluded)
    : base_{rig.plant, rig.terms}, candidates_(candidates_for(rig, train)) {
  std::erase_if(candidates_, [&](const Candidate& candidate) {
    return std::find(excluded.begin(), excluded.end(), candidate.cause) != excluded.end();
  });
  const double natural_radps = std::sqrt(rig.plant.gravity_mps2 / rig.start.position[plant::kHoist]);
  train_drive_ = std::make_unique<Problem>(train, Part::drive, kDriveWindow_s, natural_radps);
  train_load_ = std::make_unique<Problem>(train, Part::load, kSwingWindow_s, natural_radps);
  test_drive_ = std::make_unique<Problem>(test, Part::drive, kDriveWindow_s, natural_radps);
  test_load_ = std::make_unique<Problem>(test, Part::load, kSwingWindow_s, natural_radps);
}

Crane Study::with(const Effects& effects) const {
  Crane crane = base_;
  for (const Effect& effect : effects) crane.terms.push_back(effect.candidate->setting(effect.values));
  return crane;
}

double Study::learn_disturbance(const Effects& effects) {
  double misfit = 0;
  const Crane crane = with(effects);
  for (const auto& [train, test] :
       {std::pair{train_drive_.get(), test_drive_.get()}, {train_load_.get(), test_load_.get()}}) {
    if (train->empty()) continue;
    train->learn_disturbance(crane);
    for (const Disturbance& disturbance : train->disturbances()) misfit += disturbance.misfit;
    if (!test->empty()) test->whiten_like(*train);
  }
  base_train_ =
      summed(*train_drive_, *train_load_, fit_of(*train_drive_, base_), fit_of(*train_load_, base_));
  base_test_ = summed(*test_drive_, *test_load_, fit_of(*test_drive_, base_), fit_of(*test_load_, base_));
  return misfit;
}

Evaluation Study::evaluate(const Problem& drive, const Problem& load, const Effects& effects,
                           const Evaluation& near) const {
  const Crane crane = with(effects);
  bool in_drive = false, in_load = false;
  for (const Effect& effect : effects) {
    in_drive = in_drive || effect.candidate->drive;
    in_load = in_load || effect.candidate->load;
  }
  return summed(drive, load, in_drive ? drive.fit_near(crane, near.drive) : near.drive,
                in_load ? load.fit_near(crane, near.load) : near.load);
}

Evaluation Study::train(const Effects& effects) const {
  return evaluate(*train_drive_, *train_load_, effects, base_train_);
}
Evaluation Study::test(const Effects& effects) const {
  return evaluate(*test_drive_, *test_load_, effects, base_test_);
}

Study::Slopes Study::slopes(const Effects& effects, const Evaluation& at) const {
  Slopes result;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const Candidate& candidate = *effects[e].candidate;
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
      const FreeParameter& p = candidate.parameters[i];
      Effects moved = effects;
      double& value = moved[e].values[i];
      const double step = value + p.step <= p.high ? p.step : -p.step;
      value += 0.3 * step;
      const Crane crane = with(moved);
      result.drive.push_back(candidate.drive && !train_drive_->empty()
                                 ? train_drive_->change(crane, at.drive, 0.3 * step)
                                 : std::vector<VectorXd>{});
      result.load.push_back(candidate.load && !train_load_->empty()
                                ? train_load_->change(crane, at.load, 0.3 * step)
                                : std::vector<VectorXd>{});
    }
  }
  return result;
}

}  // namespace crane::diagnosis
