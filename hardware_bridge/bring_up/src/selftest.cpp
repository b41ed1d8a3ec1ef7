#include "crane/bring_up/selftest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/bring_up/jog.hpp"
#include "crane/bring_up/swing_fit.hpp"

namespace crane::bring_up {
namespace {

constexpr double kFirstPush_v = 1, kMorePush_v = 0.5;
// voltage of the push against a closed brake; limited by largest_v()
constexpr double kBrakeTest_v = 3;
constexpr std::array<double, kDrives> kPushDistance{0.03, 0.1,
                                                    0.02};  // m, rad, m: large enough for a visible swing
constexpr double kSwingSeen_rad = 0.015;

class SelftestMotions {
 public:
  SelftestMotions(Session& session, const SelftestOptions& options)
      : session_{session},
        rig_{session.rig()},
        options_{options},
        frequency_radps_{swing_frequency_radps(rig_)} {}

  Evidence run() {
    options_.progress("at rest");
    session_.record_braked(0.2);
    const auto inputs = session_.sample().inputs;
    evidence_.estop_pressed = inputs.estop_pressed;
    evidence_.relay_closed_at_rest = !inputs.watchdog_dropped;
    for (std::size_t i = 0; i < kDrives; ++i) {
      evidence_.axis[i].closed_at_rest = inputs.brake_closed[i];
      evidence_.axis[i].limit_open = inputs.limit_low[i] || inputs.limit_high[i];
    }
    if (evidence_.estop_pressed || evidence_.relay_closed_at_rest) return evidence_;
    try_relay();
    if (!evidence_.relay_closed || !evidence_.relay_dropped) return evidence_;
    for (std::size_t i = 0; i < kDrives; ++i)
      if (rig_.drives[i].present && !counters_swing_) try_axis(i);
    if (!counters_swing_) try_unlocked();
    session_.tick_braked();
    return evidence_;
  }

 private:
  [[nodiscard]] double period_of_load_s() const { return 2 * std::numbers::pi / frequency_radps_; }
  [[nodiscard]] double largest_v(std::size_t i) const {
    return std::min(options_.largest_v, rig_.drives[i].volt_limit_v);
  }

  void try_relay() {
    options_.progress("watchdog relay");
    session_.close_relay();
    evidence_.relay_closed = !session_.sample().inputs.watchdog_dropped;
    for (std::size_t i = 0; i < kDrives; ++i)
      evidence_.axis[i].closed_in_use = session_.sample().inputs.brake_closed[i];
    evidence_.relay_limit_s = rig_.wiring.relay_timeout_s + 2 * rig_.period_s;
    session_.record_braked(evidence_.relay_limit_s);
    evidence_.relay_dropped = session_.sample().inputs.watchdog_dropped;
  }

  void try_axis(std::size_t i) {
    auto& axis = evidence_.axis[i];
    if (axis.limit_open) return;
    options_.progress("brake of " + std::string{coordinate_name(i)});
    push_against_brake(i);
    if (!axis.held) return;
    options_.progress("drive of " + std::string{coordinate_name(i)});
    push(i);
  }

  /// Pushes the axis against its closed brake, briefly in both directions. If the brake does not
  /// hold, the axis moves by a few centimetres at most.
  void push_against_brake(std::size_t i) {
    auto& axis = evidence_.axis[i];
    axis.push_v = std::min(kBrakeTest_v, largest_v(i));
    for (const double sign : {1.0, -1.0}) {
      const auto jog = bring_up::run(
          session_, {.axis = i, .drive_v = sign * axis.push_v, .distance = kStandstill, .duration_s = 0.1});
      double slipped = 0;
      for (std::size_t k = 0; k < kDrives; ++k)
        if (std::abs(jog.moved[k]) > std::abs(slipped)) slipped = jog.moved[k];
      if (std::abs(slipped) <= kStandstill) continue;
      axis.held = false;
      axis.slipped = std::abs(slipped);
      return;
    }
  }

  /// Pushes with increasing voltage until an axis moves. Measures the swing before and after.
  void push(std::size_t i) {
    const auto before = swings();
    Record motion;
    for (double drive_v = std::min(kFirstPush_v, largest_v(i)); drive_v <= largest_v(i);
         drive_v += kMorePush_v) {
      const auto jog = bring_up::run(session_, plan(i, drive_v, before));
      motion.insert(motion.end(), jog.record.begin(), jog.record.end());
      note(i, drive_v, jog);
      if (!evidence_.axis[i].opened || !evidence_.axis[i].closed_again || jog.limit) break;
      if (moved_enough(i, jog) || swing_seen(motion.back(), before)) break;
    }
    if (!evidence_.axis[i].opened) return;
    session_.tick_braked();
    watch_load(i, motion, before);
  }

  [[nodiscard]] JogPlan plan(std::size_t i, double drive_v,
                             const std::array<SwingFit, kSwingCount>& before) const {
    JogPlan plan{.axis = i, .drive_v = drive_v, .distance = kPushDistance[i], .duration_s = 0.5};
    plan.release[i] = true;
    if (swing_of(rig_, i) != 0)
      plan.ends_when = [this, i, &before, first = session_.sample()](const Sample& now) {
        return std::abs(now.coordinate[i] - first.coordinate[i]) < kStandstill && swing_seen(now, before);
      };
    return plan;
  }

  void note(std::size_t i, double drive_v, const Jog& jog) {
    auto& axis = evidence_.axis[i];
    axis.push_v = drive_v;
    axis.drift = jog.drift;
    axis.opened = jog.opened[i];
    axis.other_opened = jog.opened;
    axis.other_opened[i] = false;
    axis.closed_again = jog.closed_again;
    axis.pushed = axis.opened;
    for (std::size_t k = 0; k < kDrives; ++k) axis.moved[k] += jog.moved[k];
  }

  static bool moved_enough(std::size_t i, const Jog& jog) {
    for (std::size_t k = 0; k < kDrives; ++k)
      if (std::abs(jog.moved[k]) > kPushDistance[i] / 2) return true;
    return false;
  }

  /// True when the push has added a visible swing.
  [[nodiscard]] bool swing_seen(const Sample& now, const std::array<SwingFit, kSwingCount>& before) const {
    for (std::size_t k = 0; k < kSwingCount; ++k)
      if (std::abs(now.coordinate[kDrives + k] - before[k].at(now.time_s, frequency_radps_)) > kSwingSeen_rad)
        return true;
    return false;
  }

  [[nodiscard]] std::array<SwingFit, kSwingCount> swings() {
    std::array<SwingFit, kSwingCount> fits;
    if (rig_.encoders[3].counts_per_unit <= 0 && rig_.encoders[4].counts_per_unit <= 0) return fits;
    const auto record = session_.record_braked(period_of_load_s());
    for (std::size_t k = 0; k < kDrives; ++k) counter_fits_[k] = fit_swing(record, k, frequency_radps_);
    for (std::size_t k = 0; k < kSwingCount; ++k) fits[k] = fit_swing(record, kDrives + k, frequency_radps_);
    return fits;
  }

  void watch_load(std::size_t i, const Record& motion, const std::array<SwingFit, kSwingCount>& before) {
    auto& axis = evidence_.axis[i];
    const auto after = swings();
    for (std::size_t k = 0; k < kSwingCount; ++k) {
      axis.shifted_rad[k] = after[k].offset_rad - before[k].offset_rad;
      axis.swung_rad[k] =
          std::hypot(after[k].cosine_rad - before[k].cosine_rad, after[k].sine_rad - before[k].sine_rad);
    }
    const auto swing = swing_of(rig_, i);
    if (swing == 0) return;
    for (std::size_t k = 0; k < kDrives; ++k) {
      axis.counter_swings_rad[k] = counter_fits_[k].amplitude_rad() * rig_.encoders[k].counts_per_unit /
                                   rig_.encoders[swing].counts_per_unit;
      counters_swing_ = counters_swing_ || axis.counter_swings_rad[k] > kNoSwing_rad;
    }
    const double lever = i == plant::kTrolley ? 1 : -rig_.start.position[plant::kTrolley];
    const auto expected =
        expected_swing(motion, i, lever, rig_.start.position[plant::kHoist], frequency_radps_);
    axis.expected_rad = expected.amplitude_rad();
    axis.share = share_of(expected, before[swing - kDrives], after[swing - kDrives]);
  }

  [[nodiscard]] bool did_not_move(std::size_t i) const {
    const auto& axis = evidence_.axis[i];
    return axis.pushed &&
           std::all_of(axis.moved.begin(), axis.moved.end(),
                       [](double moved) { return std::abs(moved) <= kStandstill; }) &&
           (swing_of(rig_, i) == 0 || std::max(axis.swung_rad[0], axis.swung_rad[1]) <= kNoSwing_rad);
  }

  /// Two drives that seem dead may be swapped: repeats the push with the brakes of all such axes open.
  void try_unlocked() {
    std::array<bool, kDrives> still{};
    for (std::size_t i = 0; i < kDrives; ++i) still[i] = rig_.drives[i].present && did_not_move(i);
    if (std::count(still.begin(), still.end(), true) < 2) return;
    for (std::size_t i = 0; i < kDrives; ++i) {
      if (!still[i]) continue;
      options_.progress("axis that the drive of " + std::string{coordinate_name(i)} + " moves");
      for (double drive_v = std::min(kFirstPush_v, largest_v(i)); drive_v <= largest_v(i);
           drive_v += kMorePush_v) {
        const auto jog = bring_up::run(
            session_, {.axis = i, .drive_v = drive_v, .distance = 0.01, .duration_s = 0.5, .release = still});
        std::copy_n(jog.moved.begin(), kDrives, evidence_.axis[i].moved_unlocked.begin());
        if (jog.limit || std::any_of(jog.moved.begin(), jog.moved.begin() + kDrives,
                                     [](double moved) { return std::abs(moved) > kStandstill; }))
          break;
      }
    }
  }

  Session& session_;
  const configuration::Rig& rig_;
  const SelftestOptions& options_;
  double frequency_radps_;
  Evidence evidence_;
  std::array<SwingFit, kDrives> counter_fits_;  ///< of the counters of the drives, with closed brakes
  /// true: a drive's counter shows the swing, so that further pushes give no evidence
  bool counters_swing_ = false;
};

}  // namespace

Evidence gather(Session& session, const SelftestOptions& options) {
  return SelftestMotions{session, options}.run();
}

}  // namespace crane::bring_up
