#pragma once
/// Whether the residual is still that of the model, and if not, which cause fits best. docs/twin.md has the
/// equations.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/twin/columns.hpp"
#include "crane/twin/hypothesis.hpp"

namespace crane::twin {

struct Design {
  double horizon_s = 0.3;       ///< memory of a prediction, > 0
  double block_s = 0.5;         ///< evidence is added up block by block, > 0
  double settle_s = 2;          ///< after a restart nothing is judged for so long
  double learn_s = 20;          ///< of motion in control, from which the scatter is learnt
  double false_alarm_s = 36e3;  ///< of judged time between two false alarms, all tests together
};

/// Sums over the ticks of one block. Amounts count in references: 1 is the reference size of a hypothesis.
struct Block {
  explicit Block(std::size_t hypotheses) : score(hypotheses), information(hypotheses) {}
  int ticks = 0, moving_ticks = 0;
  PerColumn energy{};                  ///< sum of e^2
  std::vector<PerColumn> score;        ///< sum of phi e, phi the change of the prediction by the reference
  std::vector<PerColumn> information;  ///< sum of phi^2
  [[nodiscard]] bool moving() const { return 5 * moving_ticks >= ticks; }
};

/// A cause with its estimated size in the unit of its hypothesis.
struct Finding {
  std::string cause, axis, unit, remedy;
  double size = 0, size_std = 0;
  std::string rival;  ///< another cause that fits nearly as well, with its axis; empty: none
  std::optional<std::size_t> hypothesis;  ///< its index; nothing: unknown, or a step
  std::size_t column = 0;                 ///< in which the residual stands out most
  double explained = 0;                   ///< share of the residual's energy
  double lead = 0;                        ///< log likelihood ratio to the rival
};

enum class Phase : std::uint8_t { learning, watching, deviates };

class Judge {
 public:
  /// @pre hypotheses.size() > 0
  /// @param floor smallest standard deviation a residual can have: the sensors' resolution
  Judge(std::vector<Hypothesis> hypotheses, const Design& design, const PerColumn& floor, int block_ticks);

  void add(const Block& block);
  /// A step that no hypothesis describes: encoder slipped, load pushed. It counts as the deviation until it
  /// has not come again for a while.
  void found(const Finding& step);

  [[nodiscard]] Phase phase() const { return phase_; }
  [[nodiscard]] double learnt_share() const;
  /// Of the strongest test; 1 raises the alarm.
  [[nodiscard]] double evidence() const;
  [[nodiscard]] const PerColumn& band() const { return band_; }  ///< 0 until learnt
  /// The cause, from the alarm on; it may still change until `named()`.
  [[nodiscard]] const std::optional<Finding>& finding() const { return finding_; }
  [[nodiscard]] bool named() const { return named_; }
  [[nodiscard]] const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }

 private:
  /// One-sided CUSUM; it remembers since when it has been above zero.
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
    double gain = 0, amount = 0, information = 0;  ///< gain: energy that it explains
  };
  static constexpr double kCertainLead = 5;  ///< log likelihood ratio that separates two causes: 150 to 1

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
  std::vector<double> inflation_;  ///< of the scores' variance over that of white residuals
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
  std::size_t onset_blocks_ = 0;  ///< blocks that the deviation has lasted
  int blocks_of_doubt_ = 0, quiet_blocks_ = 0;
  double return_evidence_ = 0;
};

}  // namespace crane::twin
