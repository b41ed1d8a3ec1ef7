#pragma once
/// A single event in the residual of one column: the encoder has jumped (a step of what is reported), or the
/// load was pushed (a step of its rate). Both fade within the horizon of the predictor; which one it was is
/// decided by their shapes over the next ticks. A force that sets in is neither: the judge's matter.
#include <array>
#include <optional>

namespace crane::twin {

enum class StepKind { slip, push };
struct Step {
  StepKind kind = StepKind::slip;
  double size = 0;  ///< m or rad; push: per second
};

class StepWatch {
 public:
  /// @param least_jump no smaller jump is one: what resolution and an unexpected acceleration can do in a
  /// tick
  StepWatch(double period_s, double horizon_s, double least_jump);
  /// Forgets the ticks so far, not what was learnt.
  void restart();
  /// One residual. @return a step, some ticks after it happened; nothing while `learning`
  std::optional<Step> add(double residual, bool learning);

 private:
  static constexpr std::size_t kShape_ticks = 10, kBefore_ticks = 6, kHistory = kShape_ticks + kBefore_ticks;
  [[nodiscard]] std::optional<Step> classify() const;
  [[nodiscard]] double at(std::size_t back) const { return history_[(newest_ + kHistory - back) % kHistory]; }

  double period_s_, least_jump_;
  std::array<double, kHistory> slip_shape_{}, push_shape_{}, force_shape_{};  ///< residual after a step of 1
  std::array<double, kHistory> history_{};
  std::size_t newest_ = 0, filled_ = 0;
  double largest_1_ = 0, largest_5_ = 0;  ///< jumps over one and five ticks in control
  std::size_t until_decision_ = 0;
};

}  // namespace crane::twin
