#pragma once
/// Detects a step in the residual of one column: a jump of the encoder (step of the measured value), or a
/// push of the load (step of its rate). Both residuals decay within the horizon of the predictor; their
/// shapes over the next ticks distinguish them. A constant force is not reported here, because Judge detects
/// it.
#include <array>
#include <optional>

namespace crane::twin {

enum class StepKind {
  slip,  ///< the encoder has jumped
  push   ///< the load was pushed
};
struct Step {
  StepKind kind = StepKind::slip;
  double size = 0;  ///< slip: m or rad; push: rad/s
};

class StepWatch {
 public:
  /// @param horizon_s   time constant of the predictor
  /// @param least_jump  smallest jump, m or rad: larger than the effect of resolution and unexpected
  ///   acceleration in one tick
  StepWatch(double period_s, double horizon_s, double least_jump);
  /// Discards the stored residuals and keeps the learnt limits.
  void restart();
  /// Adds one residual. @return a step, kShape_ticks after it happened; nothing while `learning`
  std::optional<Step> add(double residual, bool learning);

 private:
  static constexpr std::size_t kShape_ticks = 10, kBefore_ticks = 6, kHistory = kShape_ticks + kBefore_ticks;
  [[nodiscard]] std::optional<Step> classify() const;
  [[nodiscard]] double at(std::size_t back) const { return history_[(newest_ + kHistory - back) % kHistory]; }

  double period_s_, least_jump_;
  std::array<double, kHistory> slip_shape_{}, push_shape_{}, force_shape_{};  ///< residual after a step of 1
  std::array<double, kHistory> history_{};
  std::size_t newest_ = 0, filled_ = 0;
  double largest_1_ = 0, largest_5_ = 0;  ///< largest in-control changes over one and five ticks
  std::size_t until_decision_ = 0;
};

}  // namespace crane::twin
