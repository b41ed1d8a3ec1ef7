#pragma once
/// One body of data, one base model, its candidates: score tests and fits of hypotheses.
#include <Eigen/Dense>
#include <cstdint>
#include <limits>
#include <vector>

#include "crane/diagnosis/accuracy.hpp"
#include "crane/diagnosis/candidate.hpp"
#include "robust.hpp"
#include "shooting/equation_error.hpp"
#include "shooting/problem.hpp"
#include "study/hypothesis.hpp"
#include "study/probe_slopes.hpp"
#include "study/score.hpp"

namespace crane::diagnosis {

/// Fit and noise model alternate until a round decreases minus twice the log likelihood by less than
/// kWorthARound.
inline constexpr int kMostNoiseRounds = 6;
inline constexpr double kWorthARound = 2;

struct BlockScores;
struct Uncertainty;

class Study {
 public:
  /// @param train, test outlive the study
  /// @param excluded causes that are not candidates @param accuracy of the rig file; by default it is exact
  Study(const configuration::Rig& rig, const Runs& train, const Runs& test,
        const std::vector<std::string>& excluded = {}, const Accuracy& accuracy = {});
  Study(const configuration::Rig& rig, const Runs& train, Runs&& test,
        const std::vector<std::string>& excluded = {}, const Accuracy& accuracy = {}) = delete;
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }
  [[nodiscard]] const Crane& base() const { return base_; }
  [[nodiscard]] double natural_radps() const { return natural_radps_; }  ///< of the load, rad/s
  /// The crane of the rig file with its present inaccuracies and with these effects. The effects replace the
  /// inaccuracies of the same cause.
  [[nodiscard]] Crane with(const Effects& effects) const;

  /// Standard deviation of the unknown zero of a swing sensor: it is somewhere within one resolution.
  [[nodiscard]] double zero_std_dev(Output swing) const;

  /// Learns noise and disturbance from the residuals of the base model with the effects, then evaluates the
  /// base model. Without effects, also fits the inaccuracies of the rig file. Must be the first call.
  void learn_disturbance(const Effects& effects = {});
  /// The same with nuisance parameters that were learnt from the same runs before.
  void whiten_with(const Nuisance& nuisance);
  [[nodiscard]] Nuisance nuisance() const;
  /// Nuisance parameters of the base model with an exact rig file.
  [[nodiscard]] const Nuisance& uncalibrated() const { return uncalibrated_; }
  /// Fits the effects from these values in the noise of `near`, then learns the noise of the residuals. Ranks
  /// hypotheses for refit_with_own_noise(). @param near  fit of some of the effects
  /// @pre the training data are whitened with the noise of `near`
  [[nodiscard]] Fitted first_fit(const Effects& effects, const Fitted& near) const;
  /// Alternates the fit of effects and inaccuracies with the noise while the likelihood increases. Afterwards
  /// the nuisance parameters of the result are set.
  [[nodiscard]] Fitted refit_with_own_noise(const Fitted& first_fit);
  /// The base model in its own noise. @pre learn_disturbance() was the last call
  [[nodiscard]] Fitted base_model() const;
  /// Sets the nuisance parameters of a fit: the inaccuracies, and the noise that whitens the training data.
  void whiten_training(const Nuisance& nuisance);
  /// Minus twice the log likelihood of the held-out data by block. The noise is learnt from the residuals of
  /// the held-out data, because the error of a model depends on the motion.
  [[nodiscard]] Blocks held_out_deviance(const Fitted& fitted);

  /// Present inaccuracies, except those that have the value of the rig file and those whose cause and axis an
  /// effect has.
  [[nodiscard]] Effects calibration_beside(const Effects& effects) const;

  /// The base model.
  [[nodiscard]] const Evaluation& base_train() const { return base_train_; }
  /// Simulates only the parts in which `effects` are visible; copies the others from the base model.
  [[nodiscard]] Evaluation train(const Effects& effects) const;
  /// @param near  evaluation of some of the effects; gives the initial starts of the windows
  [[nodiscard]] Evaluation train(const Effects& effects, const Evaluation& near) const;
  /// Tests every further candidate on the residuals `at`. @param seed  of the sign flips
  /// @param known  slopes of earlier tests; receives those of this one
  [[nodiscard]] ScoreTable score(const Effects& effects, const Evaluation& at, std::uint64_t seed,
                                 ProbeSlopes& known) const;
  /// Shapes of a candidate. For a wave: the strongest lines of the missing force beside the effects.
  [[nodiscard]] std::vector<Shape> shapes_of(const Candidate& candidate, const Effects& effects) const;
  /// Least squares over the training data from the given values, within bounds.
  /// @param loss_to_beat  training loss; the fit stops early when it cannot fall below
  [[nodiscard]] Fitted fit(Effects effects,
                           double loss_to_beat = std::numeric_limits<double>::infinity()) const;
  /// The same, with the starts of the windows of `near`, an evaluation of some of the effects.
  [[nodiscard]] Fitted fit(Effects effects, double loss_to_beat, const Evaluation& near) const;

  /// The fit at the minimum of the loss near its values, beside the present inaccuracies.
  [[nodiscard]] Fitted converged(Fitted fitted) const;

  /// @pre the training data are whitened with the nuisance parameters of the fit
  [[nodiscard]] Uncertainty uncertainty_of(const Fitted& fitted) const;

  [[nodiscard]] const Problem& drive() const { return train_.drive; }
  [[nodiscard]] const Problem& load() const { return train_.load; }
  [[nodiscard]] const Problem& whole_runs() const { return whole_runs_; }  ///< of the load, training
  [[nodiscard]] const Problem& test_drive() const { return test_.drive; }
  [[nodiscard]] const Problem& test_load() const { return test_.load; }

  struct Slopes;
  /// Runs with their three residuals: windows of the drives, windows of the load, equation error.
  struct Body {
    Body(const Runs& all, double natural_radps);
    Body(const Body&) = delete;
    Body& operator=(const Body&) = delete;
    const Runs& runs;
    Problem drive, load;
    EquationError equation_error{drive};
  };

 private:
  /// Slopes that do not depend on the noise. @param known  those of the leading values
  [[nodiscard]] Slopes plain_slopes(const Effects& effects, const Evaluation& at, Slopes known) const;
  [[nodiscard]] Slopes whitened(const Slopes& plain, const Evaluation& at) const;
  [[nodiscard]] Slopes slopes(const Effects& effects, const Evaluation& at) const;
  /// The crane of the rig file with these inaccuracies and effects.
  [[nodiscard]] Crane crane_with(const Effects& inaccuracies, const Effects& effects) const;
  /// A round that decreases the Cauchy loss by less is the last one.
  static constexpr double kLeastGain = 0.3;
  /// Gauss-Newton rounds from `best`. @param along  plain slopes at `best` of its leading values, as far as
  /// known; those of the result on return, all or none
  /// @param apart  number of leading effects whose values also change alone
  /// @return false when the loss cannot fall below `loss_to_beat`
  /// @param least_gain  a round that decreases the Cauchy loss by less is the last one
  bool descend(Fitted& best, Loss loss, double loss_to_beat, Slopes& along, std::size_t apart,
               double least_gain = kLeastGain) const;
  /// fit() that begins with known plain slopes. @param along  of the effects, at their values, or empty;
  /// those of the result on return
  [[nodiscard]] Fitted fit(Effects effects, double loss_to_beat, const Evaluation& near, Slopes& along) const;
  /// As calibration_beside(), and also the inaccuracies that have the value of the rig file.
  [[nodiscard]] Effects inaccuracies_beside(const Effects& effects) const;
  /// The part of inaccuracies_beside() that is visible in the same parts of the data as one of the effects.
  [[nodiscard]] Effects visible_inaccuracies_beside(const Effects& effects) const;
  struct HeldError;
  /// Errors of the zeros of the swing sensors. Appends an effect for each zero that no effect describes.
  [[nodiscard]] std::vector<HeldError> zero_errors(Effects& effects) const;
  /// Errors of the masses of the drives, if the load mass is a value of the effects.
  [[nodiscard]] std::vector<HeldError> mass_errors(const Effects& effects) const;
  /// Appends the slopes of the inaccuracies `beside` of the base model, if the simulation with the effects is
  /// like that of the base model. @param along  of the effects
  void append_base_slopes(const Fitted& fitted, const Effects& beside, Slopes& along) const;
  /// Fits the inaccuracies of the rig file: an error within the accuracy belongs to the base model, not to
  /// the noise.
  void calibrate();
  /// Fits the effects jointly with the inaccuracies that are visible in the same parts of the data.
  /// @param along  plain slopes of the effects, or also of these inaccuracies, at the values of the fit;
  /// those of both on return
  void fit_inaccuracies(Fitted& fitted, Slopes& along);
  /// True if fit_inaccuracies() suffices when only the noise model has changed.
  [[nodiscard]] bool fitted_jointly(const Effects& effects) const;
  /// Sets covariance and penalty of a fit. @param along slopes, of the effects first
  void estimate_uncertainty(Fitted& fitted, const Slopes& along, const Effects& beside) const;
  /// Pattern search with decreasing steps. @param hold_bounds  parameters that are usually at a bound stay
  void step_around(Fitted& best, double Evaluation::*loss, bool hold_bounds) const;
  /// Initial values of one effect with a rough loss: the best of its rough_starts and of a pattern search by
  /// the loss of the load; from there a pattern search by the whole loss, with each parameter that is usually
  /// at a bound held at both.
  [[nodiscard]] Effects search_around(const Effects& effects, const Evaluation& near) const;
  /// Scores of directions around `at`.
  [[nodiscard]] BlockScores block_scores(const Evaluation& at, const Slopes& slopes,
                                         Loss loss = Loss::robust) const;
  /// Plain slopes of a crane that differs from that of `at` by `step`. @param unmoved plain residuals of the
  /// equation error of `at`; used if the drive is among the parts
  [[nodiscard]] PlainSlope plain_slope(const Replays& crane, const Evaluation& at, double step, ShowsIn parts,
                                       const PartVectors& unmoved) const;
  /// Parts in which the simulation with the effects differs from that of the base model by more than
  /// kLikeBase. In the others, a slope of the base model is nearly that of the hypothesis.
  [[nodiscard]] ShowsIn unlike_base(const Effects& effects, const Evaluation& at) const;
  /// Smallest visible amount of each candidate. @param slopes  by place, of its probes
  [[nodiscard]] std::vector<Visibility> excitation(const std::vector<Score>& places,
                                                   const std::vector<Slopes>& slopes,
                                                   const Evaluation& at) const;
  /// Every shape of every candidate that is not among the effects. Beside effects, a cause that adds a
  /// natural frequency has the shape that was the strongest one for the base model.
  [[nodiscard]] std::vector<Score> places(const Effects& effects, const ProbeSlopes& known) const;
  struct Probing;
  /// Appends the changes of the residuals by the probes of a candidate's shape.
  /// @param fresh  receives slopes that were not known
  /// @return decrease of the loss by free starts of the inner coordinates of the candidate
  double add_probes(const Probing& probing, const Score& place, Slopes& slopes,
                    std::vector<ProbeSlopes::Known>& fresh) const;
  /// Appends the slopes of a probe with inner coordinates that the crane of `at` does not have, and whose
  /// starts are free. @return decrease of the loss by these starts
  double add_ringing(const Replays& crane, const Evaluation& at, double step, ShowsIn parts,
                     Slopes& slopes) const;
  /// Evaluation of the base crane.
  [[nodiscard]] Evaluation evaluated(const Body& body, const Replays& base) const;
  /// Evaluation of a fit in the present noise.
  [[nodiscard]] Evaluation evaluated_again(const Fitted& fitted) const;
  /// @pre the training data are whitened
  void evaluate_base();
  [[nodiscard]] Evaluation evaluate(const Body& body, const Effects& effects, const Evaluation& near) const;
  /// Noise of the residuals of a fit, and the present inaccuracies; `unchanged` in the parts in which none of
  /// its effects is visible. @param near noise with which the search begins; empty: none is known
  [[nodiscard]] Nuisance nuisance_of(const Fitted& fitted, const Nuisance& unchanged = {},
                                     const Nuisance& near = {}) const;
  /// Noise of the residuals of one crane.
  [[nodiscard]] static Nuisance nuisance_in(const Body& body, const Evaluation& at, const Replays& crane);
  /// Minus twice the log likelihood by block in the present noise.
  [[nodiscard]] static Blocks deviance_of(const Body& body, const Evaluation& at);
  void whiten_test(const Nuisance& nuisance);
  /// Error of the simulation by output: mean over the windows of the rms error of each, m or rad.
  [[nodiscard]] std::array<double, kOutputs> errors_of(const Evaluation& at) const;
  /// Rms change of the outputs in windows when `effect` is omitted, from the starts of the fit, m or rad.
  [[nodiscard]] std::array<double, kOutputs> change_by(const Fitted& fitted, std::size_t effect) const;
  /// Sets noise and deviance in the present noise.
  void judge_by_likelihood(Fitted& fitted) const;
  /// Sets the errors of a fit, and the changes by its effects. @pre its nuisance parameters are present
  void set_sizes(Fitted& fitted) const;

  double natural_radps_;
  Crane base_;
  std::vector<Candidate> candidates_, inaccurate_;
  Effects inaccuracies_;  ///< present ones
  Nuisance uncalibrated_;
  std::vector<PlainSlope> slopes_of_inaccuracies_;  ///< of the calibrated base model, by value; or empty
  Body train_, test_;
  Problem whole_runs_;  ///< of the load, training
  Evaluation base_train_;
};

/// Step of the finite difference of a fit, with its sign: the parameter stays within its bounds.
[[nodiscard]] double difference_step(const FreeParameter& p, double value);
/// Loss of each block.
[[nodiscard]] Blocks blocks_of(const Problem& problem, const Fits& fits);

}  // namespace crane::diagnosis
