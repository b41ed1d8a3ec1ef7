#pragma once
/// One body of data, one base model, its candidates: score tests and fits of hypotheses.
#include <Eigen/Dense>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "crane/diagnosis/diagnosis.hpp"
#include "robust.hpp"
#include "shooting/equation_error.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {

/// Effects that are taken to be there, with their values.
struct Effect {
  const Candidate* candidate = nullptr;
  std::vector<double> values;
};
using Effects = std::vector<Effect>;

/// Sums of squares of consecutive pieces of the whitened residual, about `kBlock_s` of time each: what is
/// resampled. Parts follow each other: drive, with what it leaves under way, and load.
using Blocks = std::vector<double>;
inline constexpr double kBlock_s = 2.0;

/// A body of data around one crane.
struct Evaluation {
  Fits drive, load;
  std::vector<Eigen::VectorXd>
      equation_error;  ///< whitened residuals of the drives along the measured motion
  Blocks blocks;
  std::size_t drive_blocks = 0;  ///< the first of them
  double drive_loss = std::numeric_limits<double>::infinity(), load_loss = drive_loss, loss = drive_loss;
};

/// Noise and disturbance: by output of the drives, of the same along the measured motion, and of the load.
struct Noise {
  std::vector<Disturbance> drive, equation_error, load;
};

struct Fitted {
  Effects effects;
  Evaluation train;
  Noise noise;        ///< that it is whitened with
  Noise leaves;       ///< learnt from what it left when it was screened
  double misfit = 0;  ///< minus twice the log likelihood of that, the starts of windows left free
  /// Minus twice the log likelihood of the training data by block, with the price of the fitted values.
  Blocks deviance;
  double price = 0;  ///< of the values, contained in `deviance`
  Blocks left_out;   ///< what every block costs more when it is left out of the fit (Takeuchi's penalty)
  /// Error of the simulation in windows, mean over the windows of the rms of each [m or rad].
  std::array<double, kOutputs> error{};
  /// The same of swings over whole runs. Of drives the smallest error of friction integrates into position.
  std::array<double, kOutputs> whole_error{};
  std::vector<double> std_dev;  ///< of all values, one effect after the other; block-robust
  Eigen::MatrixXd covariance;   ///< the same before resampling
  Eigen::VectorXd by_noise;     ///< std_dev if noise and disturbance are exactly as learnt
  std::size_t parameters = 0;
};

/// Parts that something shows in.
struct ShowsIn {
  bool drive = false, load = false;
};

/// One candidate in one shape.
struct Score {
  std::size_t candidate = 0;
  Shape shape;
  double statistic = 0;  ///< chi-square of the block-robust score
  double p_value = 1;    ///< by itself
  double gain = 0;       ///< promised decrease of the loss; less than 0 where a shape as it is does harm
  double share = 0;      ///< the same as a share of the loss of the parts that the candidate shows in
  std::vector<double> amounts;
  std::vector<std::vector<double>> starts;  ///< values that a fit may begin at
};

struct ScoreTable {
  /// Best shape of every candidate with where its fit may begin, in the candidates' order.
  std::vector<Score> best;
  std::vector<Visibility> excitation;  ///< what the data can show; only where nothing is known
  double p_value = 1;  ///< that the largest of all comes from nothing, by flipping the signs of blocks
};

struct BlockScores;

class Study {
 public:
  /// @param train, test outlive the study
  /// @param excluded causes that are no candidates
  Study(const configuration::Rig& rig, const Runs& train, const Runs& test,
        const std::vector<std::string>& excluded = {});
  Study(const configuration::Rig& rig, const Runs& train, Runs&& test,
        const std::vector<std::string>& excluded = {}) = delete;

  [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }
  [[nodiscard]] const Crane& base() const { return base_; }
  [[nodiscard]] double natural_radps() const { return natural_radps_; }  ///< of the load, rad/s
  [[nodiscard]] Crane with(const Effects& effects) const;

  /// Learns noise and disturbance from what the base model with the effects leaves, and evaluates the base
  /// model. Before anything else.
  void learn_disturbance(const Effects& effects = {});
  /// The same with what was learnt elsewhere, from the same runs.
  void whiten_with(const Noise& noise);
  [[nodiscard]] Noise noise() const;
  /// The effects fitted from these values in the noise of `near`, then the noise of what they leave: enough
  /// to tell which hypotheses are worth settled().
  /// @param near of some of the effects. @pre the training data are whitened with its noise
  [[nodiscard]] Fitted screened(const Effects& effects, const Fitted& near) const;
  /// Fit and noise in turn, as long as the data become likelier. From then on the training data are whitened
  /// with the noise of the result.
  [[nodiscard]] Fitted settled(const Fitted& screened);
  /// The base model in its own noise. @pre learn_disturbance() was the last call
  [[nodiscard]] Fitted bare() const;
  /// Whitens the training data with the noise of a fit from now on.
  void whiten_training(const Noise& noise);
  /// Minus twice the log likelihood of the held-out data by block, in the noise of a fit.
  [[nodiscard]] Blocks held_out_deviance(const Fitted& fitted);

  /// The base model.
  [[nodiscard]] const Evaluation& base_train() const { return base_train_; }
  /// Only the parts that `effects` show in are simulated again.
  [[nodiscard]] Evaluation train(const Effects& effects) const;
  /// @param near of some of the effects: where the starts of the windows begin
  [[nodiscard]] Evaluation train(const Effects& effects, const Evaluation& near) const;
  /// Does one more effect explain what `at` leaves? @param seed of the sign flips
  [[nodiscard]] ScoreTable score(const Effects& effects, const Evaluation& at, std::uint64_t seed) const;
  /// Shapes of a candidate; those of a wave are the strongest in the force that is missing beside the
  /// effects.
  [[nodiscard]] std::vector<Shape> shapes_of(const Candidate& candidate, const Effects& effects) const;
  /// Least squares over the training data from the given values, within bounds.
  /// @param hopeless a training loss: the fit is given up when it will not come below it
  [[nodiscard]] Fitted fit(Effects effects, double hopeless = std::numeric_limits<double>::infinity()) const;
  /// The same beginning near where some of the effects have been evaluated.
  [[nodiscard]] Fitted fit(Effects effects, double hopeless, const Evaluation& near) const;

  [[nodiscard]] const Problem& drive() const { return train_.drive; }
  [[nodiscard]] const Problem& load() const { return train_.load; }
  [[nodiscard]] const Problem& test_drive() const { return test_.drive; }
  [[nodiscard]] const Problem& test_load() const { return test_.load; }

  struct Slopes;
  /// Runs, in their three views.
  struct Body {
    Body(const Runs& all, double natural_radps);
    Body(const Body&) = delete;
    Body& operator=(const Body&) = delete;
    const Runs& runs;
    Problem drive, load;
    EquationError equation_error{drive};
  };

 private:
  [[nodiscard]] Slopes slopes(const Effects& effects, const Evaluation& at) const;
  /// Gauss-Newton rounds from where `best` is. @param along slopes there where they are known, before and
  /// after @return whether there is still hope
  bool descend(Fitted& best, Loss loss, double hopeless, std::optional<Slopes>& along) const;
  /// The same by trying: every value by itself, in steps that shrink.
  void step_around(Fitted& best, double Evaluation::*loss) const;
  /// Scores of directions around `at`.
  [[nodiscard]] BlockScores block_scores(const Evaluation& at, const Slopes& slopes,
                                         Loss loss = Loss::robust) const;
  /// Appends the changes per unit that `crane` makes in the parts.
  /// @return what the start of coordinates of its own gains
  double add_slope(const Crane& crane, const Evaluation& at, double step, ShowsIn parts,
                   Slopes& slopes) const;
  /// What the data can show of the candidates. @param slopes by place, of its probes
  [[nodiscard]] std::vector<Visibility> excitation(const std::vector<Score>& places,
                                                   const std::vector<Slopes>& slopes,
                                                   const Evaluation& at) const;
  /// Every shape of every candidate that is not among the effects.
  [[nodiscard]] std::vector<Score> places(const Effects& effects) const;
  /// Appends the changes that the probes of a candidate's shape make.
  /// @return what the start of its own coordinates gains
  double add_probes(const Effects& effects, const Evaluation& at, const Score& place, Slopes& slopes) const;
  /// Around the base crane.
  [[nodiscard]] Evaluation evaluated(const Body& body, const Replays& base) const;
  /// The training data around a fit in another noise.
  [[nodiscard]] Evaluation evaluated_again(const Fitted& fitted) const;
  /// @pre the training data are whitened
  void evaluate_base();
  [[nodiscard]] Evaluation evaluate(const Body& body, const Effects& effects, const Evaluation& near) const;
  /// Noise of what a fit leaves; `unchanged` in the parts that none of its effects shows in.
  [[nodiscard]] Noise noise_of(const Fitted& fitted, const Noise& unchanged = {}) const;
  /// Minus twice the log likelihood by block in the present noise.
  [[nodiscard]] static Blocks deviance_of(const Body& body, const Evaluation& at);
  void whiten_test(const Noise& noise);
  /// Sets noise and deviance in the present noise.
  void judge_by_likelihood(Fitted& fitted) const;

  double natural_radps_;
  Crane base_;
  std::vector<Candidate> candidates_;
  Body train_, test_;
  Problem whole_runs_;  ///< of the load, training
  Evaluation base_train_;
};

/// Every value moved by its number of `step`, within its bounds: rounding must not carry it beyond.
[[nodiscard]] Effects moved(Effects effects, const Eigen::VectorXd& step);
/// Loss of each block.
[[nodiscard]] Blocks blocks_of(const Problem& problem, const Fits& fits);
[[nodiscard]] double sum(const Blocks& blocks);

}  // namespace crane::diagnosis
