#include "campaign/judge/tick_invariants.hpp"

#include <algorithm>
#include <cmath>

#include "campaign/judge/row_facts.hpp"

namespace crane::campaign {
namespace {

constexpr double kOutside = 1e-3;          // I1: m, rad; small compared with any stopping distance
constexpr double kSlip = 1e-3;             // I4: m, rad
constexpr double kAtRest = 1e-6;           // m/s, rad/s: the simulated rig locks an axis below this speed
constexpr std::size_t kOldestCommand = 6;  // ticks: the bridge applies a command for at most five ticks

class TickInvariants {
 public:
  TickInvariants(const configuration::Rig& rig, const Run& run, Verdict& verdict)
      : rig_{rig}, run_{run}, verdict_{verdict} {}

  void check(std::size_t k) {
    inside_limits(k);
    follows_latch(k);
    runaway_swing(k);
    braked_stays(k);
    reset_and_arm(k);
    if (k > 0) only_supervisor(k);
    if (k > 0) volts_in_range(k);
  }

 private:
  void violated(Invariant invariant, std::size_t k, std::string what) {
    add_violation(run_, invariant, k, std::move(what), verdict_);
  }

  void inside_limits(std::size_t k) {
    const Truth& truth = run_.rows[k].truth;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const auto& drive = rig_.drives[i];
      if (!drive.present || truth.brake_closed[i]) continue;
      const double beyond =
          std::max(truth.position[i] - drive.high_limit, drive.low_limit - truth.position[i]);
      verdict_.beyond_limit = std::max(verdict_.beyond_limit, beyond);
      if (beyond > kOutside && !run_.expectation.position_is_wrong && !run_.expectation.brakes_do_not_close)
        violated(Invariant::inside_limits, k,
                 "axis " + std::to_string(i) + " is " + std::to_string(beyond) +
                     " beyond its hard limit with its brake open");
    }
  }

  /// When the bridge has latched, the supervisor must stop, too.
  void follows_latch(std::size_t k) {
    constexpr std::size_t kTicks = 3;
    if (k < kTicks || run_.expectation.supervisor_gone || run_.expectation.supervisor_faulty) return;
    const bool latched = run_.rows[k - kTicks].state.latch_reason != crane_LATCH_NONE &&
                         run_.rows[k].state.latch_reason != crane_LATCH_NONE;
    const auto state = run_.rows[k].status.state;
    if (latched && (state == crane_STATE_HOLD || state == crane_STATE_RUN))
      violated(Invariant::right_reason, k, "the supervisor continues although the bridge has latched");
  }

  /// A controlled stop cannot damp a swing above 1.25 times its limit: 0 V is required.
  void runaway_swing(std::size_t k) {
    constexpr double kRunaway = 1.25, kReserve = 1.02, kBound_ms = 50;
    const Truth& truth = run_.rows[k].truth;
    const double limit_rad = kRunaway * kReserve * rig_.limits.swing_limit_rad;
    const bool beyond =
        std::abs(truth.swing_radial_rad) > limit_rad || std::abs(truth.swing_tangential_rad) > limit_rad;
    if (beyond && !runaway_ns_) runaway_ns_ = run_.rows[k].time_ns;
    if (runaway_ns_ && ms(*runaway_ns_, run_.rows[k].time_ns) > kBound_ms && !no_volts(run_.rows[k]) &&
        !run_.expectation.supervisor_gone && !run_.expectation.supervisor_faulty &&
        !run_.expectation.volts_by_rig)
      violated(Invariant::zero_volts, k, "volts on although the load has swung beyond 1.25 times its limit");
  }

  void braked_stays(std::size_t k) {
    const Truth& truth = run_.rows[k].truth;
    for (std::size_t i = 0; i < kAxes; ++i) {
      if (!rig_.drives[i].present) continue;
      if (!truth.brake_closed[i]) braked_at_[i].reset();
      if (truth.brake_closed[i] && !braked_at_[i] && std::abs(truth.speed[i]) <= kAtRest)
        braked_at_[i] = truth.position[i];
      if (braked_at_[i] && std::abs(truth.position[i] - *braked_at_[i]) > kSlip &&
          !run_.expectation.brakes_do_not_close)
        violated(Invariant::braked_stays, k, "axis " + std::to_string(i) + " moved under its closed brake");
    }
  }

  /// Permission to open brakes begins with reset and arm, and ends with every stop.
  void reset_and_arm(std::size_t k) {
    const Row& row = run_.rows[k];
    const bool was_released = k > 0 && !commanded_closed(run_.rows[k - 1]);
    const bool may = permitted_;
    if (is_stop(row.status.state)) permitted_ = reset_ = false;
    if (row.reset_requested) reset_ = true;
    if (row.arm_requested && reset_) permitted_ = true;
    if (row.status.state == crane_STATE_READY && !reset_)
      violated(Invariant::reset_and_arm, k, "READY without a reset");
    if (!commanded_closed(row) && !was_released && !may && !permitted_)
      violated(Invariant::reset_and_arm, k, "a brake was opened without reset and arm");
  }

  void only_supervisor(std::size_t k) {
    const Row& row = run_.rows[k];
    const bool bridge_is_dead = run_.expectation.volts_by_rig && row.time_ns >= run_.begin_ns;
    if (bridge_is_dead || (no_volts(row) && commanded_closed(row))) return;
    for (std::size_t age = 1; age <= std::min(k, kOldestCommand); ++age)
      if (is_of(run_.rows[k - age].command, row.truth)) return;
    violated(Invariant::only_supervisor, k,
             "the board received values that the supervisor has not published");
  }

  [[nodiscard]] bool is_of(const msg::Command& command, const Truth& truth) const {
    for (std::size_t i = 0; i < kAxes; ++i)
      if (std::abs(truth.written_v[i] - command.drive_v[i]) > kVolt ||
          (truth.brake_release[i] && !command.brake_release[i]))
        return false;
    return true;
  }

  void volts_in_range(std::size_t k) {
    const Row& row = run_.rows[k];
    const auto tick = row.state.applied_command_tick, before = run_.rows[k - 1].state.applied_command_tick;
    const double ticks = tick > before ? static_cast<double>(tick - before) : 1;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const double u = row.truth.written_v[i], last = run_.rows[k - 1].truth.written_v[i];
      const auto& drive = rig_.drives[i];
      const double limit_v = drive.present ? drive.volt_limit_v : 0;
      const bool towards_zero = u * last >= 0 && std::abs(u) <= std::abs(last);
      const double most_v = drive.volt_rate_limit_vps * rig_.period_s * ticks;
      if (!(std::abs(u) <= limit_v + kVolt) || !(towards_zero || std::abs(u - last) <= most_v + kVolt))
        violated(Invariant::volts_in_range, k,
                 "axis " + std::to_string(i) + " was given " + std::to_string(u) + " V after " +
                     std::to_string(last));
    }
  }

  const configuration::Rig& rig_;
  const Run& run_;
  Verdict& verdict_;
  std::array<std::optional<double>, kAxes>
      braked_at_{};  ///< position at which the closed brake stopped the axis
  std::optional<std::int64_t> runaway_ns_;
  bool reset_ = false, permitted_ = false;
};

}  // namespace

void check_every_tick(const configuration::Rig& rig, const Run& run, Verdict& verdict) {
  TickInvariants invariants{rig, run, verdict};
  for (std::size_t k = 0; k < run.rows.size(); ++k) invariants.check(k);
}

void add_violation(const Run& run, Invariant invariant, std::size_t k, std::string what, Verdict& verdict) {
  const bool known = std::ranges::any_of(
      verdict.violations, [invariant](const auto& other) { return other.invariant == invariant; });
  if (!known) verdict.violations.push_back({invariant, run.rows[k].time_ns, std::move(what)});
}

}  // namespace crane::campaign
