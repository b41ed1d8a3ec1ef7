#pragma once
/// The live twin: a model of the crane with the same input voltages, tick by tick. It predicts the sensor
/// values, tests the residual, and reports a deviation with its likely cause. No clock, bus or files.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/twin/judge.hpp"
#include "crane/twin/predictor.hpp"
#include "crane/twin/step_watch.hpp"

namespace crane::twin {

/// One tick of the rig.
struct Sample {
  std::uint64_t tick = 0;
  std::uint32_t epoch = 0;               ///< start-up number of the writer
  std::array<std::int64_t, 5> counts{};  ///< trolley, slew, hoist, radial, tangential swing; unwrapped
  PerColumn rate{};                      ///< filtered rates for the start of a prediction, m/s or rad/s
  double cable_mps = 0;
  plant::PerAxis applied_v{};             ///< voltage that acts from this tick on
  bool homed = true;                      ///< true: all positions are known
  std::array<bool, plant::kAxes> held{};  ///< true: a closed brake or an end of travel holds the axis
};

enum class State : std::uint8_t {
  waiting,   ///< no prediction, or Design::settle_s after a restart has not passed
  learning,  ///< learns the in-control scatter; ends after Design::learn_s of motion
  watching,  ///< tests the residual; ends with an alarm
  deviates   ///< names the cause; ends when the residual is in control again
};

/// Result of one tick.
struct Judgement {
  State state = State::waiting;
  PerColumn predicted{}, residual{}, band{};  ///< m or rad; residual: measured minus predicted
  double evidence = 0;                        ///< Judge::evidence()
  std::string cause, axis, unit;              ///< most likely cause; empty without a deviation
  double size = 0, size_std = 0;              ///< of the cause, in `unit`
  double learnt_share = 0;                    ///< Judge::learnt_share()
  std::uint64_t judged_ticks = 0;
  std::uint64_t gaps = 0;  ///< interruptions of the prediction
};

/// Message for crane/event: one per deviation, and one when the deviation ends.
struct Notice {
  bool deviates = false;
  std::string what, remedy;
};

class Twin {
 public:
  /// @throws std::invalid_argument when the model rejects the rig
  explicit Twin(const configuration::Rig& rig, const Design& design = {});

  const Judgement& step(const Sample& sample);
  [[nodiscard]] const Judgement& judgement() const { return judgement_; }
  /// @return the notice since the last call; nothing when there is none
  [[nodiscard]] std::optional<Notice> take_notice();

 private:
  [[nodiscard]] MeasuredTick known(const Sample& sample) const;
  [[nodiscard]] Mask free_columns(const Sample& sample) const;
  [[nodiscard]] bool usable(const Sample& sample, const MeasuredTick& now) const;
  [[nodiscard]] bool follows(const Sample& sample) const;
  void restart(const Sample& sample, const MeasuredTick& now);
  void predict(const MeasuredTick& now);
  void accumulate(const MeasuredTick& now);
  [[nodiscard]] bool could_be_push(std::size_t column) const;
  void watch_steps();
  void report();
  void announce();

  configuration::Rig rig_;
  Design design_;
  Judge judge_;
  Predictor nominal_;
  std::vector<Predictor> changed_;  ///< one model per hypothesis, with its reference size
  std::vector<StepWatch> steps_;
  std::optional<Sample> last_;
  Mask simulated_{};
  int settle_ticks_, block_ticks_;
  int to_settle_ = 0;
  Block block_;
  std::optional<Block> complete_block_;  ///< complete block, which is judged one block later, because a step
                                         ///< in its last ticks may still be detected
  Judgement judgement_;
  bool announced_ = false;
  std::optional<Notice> notice_;
};

}  // namespace crane::twin
