#pragma once
/// Adaptation of one axis: collects blocks and break-aways, and selects the levels that the compensation
/// uses.
///   reduction in motion   of a direction whose blocks show less friction than is compensated
///   installation at rest  at the end of a move, of the directions that the move has excited
///   return                to the previous levels, when the next move contradicts the installed levels or the
///                         axis oscillates about its rest
#include "adaptation/break_away.hpp"
#include "adaptation/force_balance.hpp"
#include "adaptation/level_filter.hpp"
#include "adaptation/limit_cycle.hpp"

namespace crane::control::adaptation {

class AxisAdaptation {
 public:
  AxisAdaptation(const Design& design, std::size_t axis);

  [[nodiscard]] bool adapts() const noexcept { return adapts_; }
  /// @param balance  nullptr: unknown at this tick
  /// @param reason   why the axis must not learn from this tick
  void step(const AxisBalance* balance, AdaptationFreeze reason, LevelFilter& filter) noexcept;
  /// Call when all axes have come to rest after a motion.
  void end_move(LevelFilter& filter) noexcept;
  [[nodiscard]] bool moves() const noexcept { return moves_; }
  [[nodiscard]] const AxisReport& report() const noexcept { return report_; }
  [[nodiscard]] const DriveFriction& friction() const noexcept { return friction_; }

 private:
  using Set = std::array<FrictionLevels, 2>;  ///< positive, negative
  void learn(const AxisBalance& balance, LevelFilter& filter) noexcept;
  void rest(const AxisBalance& balance, const LevelFilter& filter) noexcept;
  void finish_block(LevelFilter& filter) noexcept;
  void leave_block() noexcept { block_ticks_ = 0, block_ = {}; }
  void lower(std::size_t direction, double speed, const LevelFilter& filter) noexcept;
  [[nodiscard]] FrictionLevels wanted(std::size_t direction, const LevelFilter& filter) const noexcept;
  [[nodiscard]] bool excited(std::size_t direction, const LevelFilter& filter) const noexcept;
  void lower_after_oscillation(const LevelFilter& filter) noexcept;
  void judge(LevelFilter& filter) noexcept;
  void approach_target() noexcept;
  void describe(const LevelFilter& filter) noexcept;

  std::size_t axis_;
  bool adapts_;
  double zero_band_, share_, viscous_share_, period_s_, gain_;
  DriveFriction friction_;  ///< with the used levels
  Set rig_levels_, active_levels_, target_, previous_levels_;
  BreakAway break_away_;
  std::array<bool, 2> at_bound_{};   ///< a block of the present move was learnt with the payload at its bound
  std::array<double, 2> ceiling_{};  ///< largest permitted level / level of the rig file, by direction
  LimitCycle limit_cycle_;
  Block block_;
  int block_ticks_ = 0, skipped_ticks_ = 0;
  std::size_t block_direction_ = 0;
  int refused_in_a_row_ = 0, excess_blocks_ = 0;
  double speed_ = 0;  ///< magnitude, m/s or rad/s
  bool moves_ = false;
  double active_squares_ = 0, previous_squares_ = 0;
  int judged_blocks_ = 0, frozen_moves_ = 0;
  bool on_trial_ = false;  ///< true: no move has judged the target yet
  AdaptationFreeze held_ = AdaptationFreeze::none;
  AxisReport report_;
};

}  // namespace crane::control::adaptation
