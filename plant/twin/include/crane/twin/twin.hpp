#pragma once
/// The live twin: the model of a rig file beside the crane, fed with the same volts, tick by tick. It
/// predicts what the sensors report, keeps the residual, and says when the residual is no longer that of the
/// model, and what is likely the cause. Pure: samples in, judgement out; no clock, bus or files.
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
  std::uint32_t epoch = 0;               ///< of the writer
  std::array<std::int64_t, 5> counts{};  ///< trolley, slew, hoist, radial, tangential swing; unwrapped
  PerColumn rate{};                      ///< filtered; to begin with only
  double cable_mps = 0;
  plant::PerAxis applied_v{};             ///< acts from this tick on
  bool homed = true;                      ///< positions are known
  std::array<bool, plant::kAxes> held{};  ///< by a closed brake or a pressed limit switch
};

enum class State : std::uint8_t { waiting, learning, watching, deviates };

struct Judgement {
  State state = State::waiting;
  PerColumn predicted{}, residual{}, band{};
  double evidence = 0;
  std::string cause, axis, unit;
  double size = 0, size_std = 0;
  double learnt_share = 0;
  std::uint64_t judged_ticks = 0, gaps = 0;
};

/// Once per deviation, and once when it is over.
struct Notice {
  bool deviates = false;
  std::string what, remedy;
};

class Twin {
 public:
  /// @throws std::invalid_argument when the rig's model cannot be built
  explicit Twin(const configuration::Rig& rig, const Design& design = {});

  const Judgement& step(const Sample& sample);
  [[nodiscard]] const Judgement& judgement() const { return judgement_; }
  /// What there is to say since the last call.
  [[nodiscard]] std::optional<Notice> take_notice();

 private:
  [[nodiscard]] Known known(const Sample& sample) const;
  [[nodiscard]] Mask free_columns(const Sample& sample) const;
  [[nodiscard]] bool usable(const Sample& sample, const Known& now) const;
  [[nodiscard]] bool follows(const Sample& sample) const;
  void restart(const Sample& sample, const Known& now);
  void predict(const Known& now);
  void accumulate(const Known& now);
  [[nodiscard]] bool could_be_push(std::size_t column) const;
  void watch_steps();
  void report();
  void announce();

  configuration::Rig rig_;
  Design design_;
  Judge judge_;
  Predictor nominal_;
  std::vector<Predictor> changed_;  ///< one per hypothesis, its reference size in the model
  std::vector<StepWatch> steps_;
  std::optional<Sample> last_;
  Mask simulated_{};
  int settle_ticks_, block_ticks_;
  int to_settle_ = 0;
  Block block_;
  std::optional<Block> held_;  ///< complete, but a step that began in it may still be recognised
  Judgement judgement_;
  bool announced_ = false;
  std::optional<Notice> notice_;
};

}  // namespace crane::twin
