#pragma once
/// Tests whether the residual is in control, and finds the cause that explains a deviation best. docs/twin.md
/// states the equations.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/twin/columns.hpp"
#include "crane/twin/hypothesis.hpp"

namespace crane::twin {

struct Design {
  double horizon_s = 0.3;       ///< time constant of the predictor, > 0
  double block_s = 0.5;         ///< length of a block; each block is one observation, > 0
  double settle_s = 2;          ///< time without judgement after a restart, >= 0
  double learn_s = 20;          ///< duration of the motion from which the scatter is learnt, > 0
  double false_alarm_s = 36e3;  ///< mean judged time between false alarms of all tests together, > 0
};

/// Sums over the ticks of one block. The unit of all amounts is the reference size of a hypothesis.
struct Block {
  explicit Block(std::size_t hypotheses) : score(hypotheses), information(hypotheses) {}
  int ticks = 0, moving_ticks = 0;
  PerColumn energy{};                  ///< sum of e^2, e the residual
  std::vector<PerColumn> score;        ///< sum of phi e, phi the change of the prediction by the reference
  std::vector<PerColumn> information;  ///< sum of phi^2
  [[nodiscard]] bool moving() const { return 5 * moving_ticks >= ticks; }
};

/// A cause with its estimated size in the unit of its hypothesis.
struct Finding {
  std::string cause, axis, unit, remedy;
  double size = 0, size_std = 0;
  std::string rival;                      ///< another cause (with axis) that cannot be excluded; empty: none
  std::optional<std::size_t> hypothesis;  ///< index of the hypothesis; nothing: unknown, or a step
  std::size_t column = 0;                 ///< column with the largest normalised residual
  double explained = 0;                   ///< share of the residual's energy that the cause explains
  double log_likelihood_ratio = 0;        ///< relative to the next best cause
};

enum class Phase : std::uint8_t {
  learning,  ///< learns the in-control scatter; ends after Design::learn_s of motion
  watching,  ///< tests the residual; ends with an alarm
  deviates   ///< names the cause; ends when the residual is in control again
};

class Judge {
 public:
  /// @pre hypotheses.size() > 0
  /// @param floor  smallest standard deviation of a residual: the resolution of the sensors
  Judge(std::vector<Hypothesis> hypotheses, const Design& design, const PerColumn& floor, int block_ticks);

  void add(const Block& block);
  /// Reports a step that no hypothesis describes: encoder slipped, load pushed. The step counts as the
  /// deviation until the residual has been in control for kQuiet_blocks blocks.
  void found(const Finding& step);

  [[nodiscard]] Phase phase() const { return phase_; }
  [[nodiscard]] double learnt_share() const;  ///< learnt part of Design::learn_s, [0, 1]
  /// Statistic of the strongest test, divided by its threshold; 1 raises the alarm.
  [[nodiscard]] double evidence() const;
  /// Three standard deviations of the residual; 0 until learnt.
  [[nodiscard]] const PerColumn& band() const { return band_; }
  /// The most likely cause after an alarm. It may change until named() is true.
  [[nodiscard]] const std::optional<Finding>& finding() const { return finding_; }
  [[nodiscard]] bool named() const { return named_; }
  [[nodiscard]] const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }

 private:
  /// One-sided CUSUM with the number of blocks since it was last zero.
  struct Cusum {
    double value = 0;
    std::size_t blocks = 0;
    void add(double increment) {
      value += increment;
      ++blocks;
      if (value <= 0) value = 0, blocks = 0;
    }
  };
  struct Weighed {
    double score = 0, information = 0;
  };
  struct Fit {
    std::size_t hypothesis = 0;
    double gain = 0, amount = 0, information = 0;  ///< gain: explained energy; amount: in references
  };
  static constexpr double kCertainLogRatio = 5;  ///< log likelihood ratio that separates two causes: 150 to 1

  void learn();
  void learn_variance(const PerColumn& floor, std::size_t hypothesis, double amount);
  void learn_inflation();
  void judge(const Block& block);
  void begin_deviation();
  void name_cause();
  void look_for_return(const Block& block);
  void agree();
  [[nodiscard]] Weighed weighed(const Block& block, std::size_t hypothesis) const;
  [[nodiscard]] std::span<const Block> fitted_blocks() const;
  [[nodiscard]] std::vector<Fit> fits() const;
  void describe(const std::vector<Fit>& list, double all, double in_control, Finding& found) const;
  [[nodiscard]] Weighed weighed(std::span<const Block> blocks, std::size_t hypothesis) const;
  [[nodiscard]] double excess(const Block& block, std::size_t column) const;
  [[nodiscard]] Finding best_fit() const;

  std::vector<Hypothesis> hypotheses_;
  Design design_;
  PerColumn variance_{}, band_{};
  std::vector<double> inflation_;  ///< variance of the scores / variance for white residuals
  double threshold_;
  std::vector<Block> learnt_from_;
  double learnt_s_ = 0;
  std::vector<Block> recent_;
  std::vector<Cusum> up_, down_;
  std::array<Cusum, kColumns> energy_;
  Phase phase_ = Phase::learning;
  std::optional<Finding> finding_;
  std::optional<std::size_t> named_hypothesis_;
  bool named_ = false, is_step_ = false;
  std::size_t deviation_blocks_ = 0;  ///< duration of the deviation, blocks
  int blocks_of_doubt_ = 0, quiet_blocks_ = 0;
  double return_evidence_ = 0;
};

}  // namespace crane::twin
