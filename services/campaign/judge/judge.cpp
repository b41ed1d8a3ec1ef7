#include "campaign/judge/judge.hpp"

#include <algorithm>
#include <cmath>

#include "campaign/judge/row_facts.hpp"
#include "campaign/judge/tick_invariants.hpp"
#include "campaign/judge/truth.hpp"

namespace crane::campaign {
namespace {

constexpr double kCommunicationBound_ms = 70;  // I2: onset of a communication fault to 0 V
constexpr double kZeroVoltsBound_ms = 20;      // I2: any detection to 0 V
constexpr double kBrakesBound_ms = 10;         // I3: 0 V to brakes commanded closed: one tick
constexpr double kControlledStop_ms = 8'200;   // longest controlled stop with its ramp

bool is_controlled(const Reason& reason) {
  return reason.cause == crane_CAUSE_OPERATOR_STOP || reason.cause == crane_CAUSE_OPERATOR_DISARM ||
         reason.cause == crane_CAUSE_IDLE || reason.cause == crane_CAUSE_SWING_LIMIT ||
         reason.cause == crane_CAUSE_HOMED;
}

class Judgement {
 public:
  Judgement(const configuration::Rig& rig, const Run& run) : rig_{rig}, run_{run} {
    while (onset_ < run.rows.size() && run.rows[onset_].time_ns < run.onset_ns) ++onset_;
  }

  Verdict take() {
    check_every_tick(rig_, run_, verdict_);
    no_trip_before_onset();
    find_first_reason();
    right_reason();
    refusal();
    independent_detection();
    nothing_outwards();
    stop_times();
    return std::move(verdict_);
  }

 private:
  void violated(Invariant invariant, std::size_t k, std::string what) {
    add_violation(run_, invariant, k, std::move(what), verdict_);
  }

  void no_trip_before_onset() {
    for (std::size_t k = 0; k < run_.rows.size() && run_.rows[k].time_ns < run_.begin_ns; ++k) {
      const auto& status = run_.rows[k].status;
      const bool by_operator = status.cause <= crane_CAUSE_OPERATOR_ESTOP;
      if (run_.rows[k].state.latch_reason != crane_LATCH_NONE || (is_stop(status.state) && !by_operator))
        violated(Invariant::no_false_trip, k,
                 "stopped before the fault, cause " + std::to_string(status.cause));
    }
  }

  void find_first_reason() {
    const Row before = onset_ > 0 ? run_.rows[onset_ - 1] : Row{};
    for (first_row_ = onset_; first_row_ < run_.rows.size(); ++first_row_) {
      const Row& row = run_.rows[first_row_];
      const bool stopped = !run_.expectation.supervisor_faulty && is_stop(row.status.state) &&
                           (!is_stop(before.status.state) || row.status.cause != before.status.cause);
      const bool latched =
          row.state.latch_reason != crane_LATCH_NONE && before.state.latch_reason == crane_LATCH_NONE;
      if (!stopped && !latched) continue;
      if (ends_the_stop(before, row)) return;
      const auto cause = stopped ? row.status.cause : crane_CAUSE_BRIDGE_LATCHED;
      verdict_.first =
          Reason{cause, cause == crane_CAUSE_BRIDGE_LATCHED ? row.state.latch_reason : crane_LATCH_NONE};
      return;
    }
  }

  /// True when the operator's stop has reached its longest duration. This is not an effect of the fault.
  [[nodiscard]] bool ends_the_stop(const Row& before, const Row& row) const {
    const Reason timeout{crane_CAUSE_STOP_TIMEOUT, crane_LATCH_NONE};
    return before.status.state == crane_STATE_STOP_C1 && row.status.cause == crane_CAUSE_STOP_TIMEOUT &&
           std::ranges::find(run_.expectation.reasons, timeout) == run_.expectation.reasons.end();
  }

  void right_reason() {
    const auto& wanted = run_.expectation;
    if (run_.rows.empty() || !verdict_.first) return undetected();
    const auto seen_ns = run_.visible_ns.value_or(run_.onset_ns);
    const double detection_ms = ms(seen_ns, run_.rows[first_row_].time_ns);
    if (wanted.reasons.empty()) {
      violated(Invariant::no_false_trip, first_row_, "the crane stopped although it must continue");
    } else if (std::ranges::find(wanted.reasons, *verdict_.first) == wanted.reasons.end() &&
               (wanted.position_is_wrong || !is_true(*verdict_.first, rig_, run_.rows, first_row_))) {
      violated(Invariant::right_reason, first_row_, "a wrong reason came first");
    } else if (run_.visible_ns && detection_ms > wanted.detection_ms + 1e-6) {
      violated(Invariant::right_reason, first_row_, "detected after " + std::to_string(detection_ms) + " ms");
    }
    if (run_.visible_ns) verdict_.detection_ms = std::max(detection_ms, 0.0);
  }

  /// Detection is not required when the effect was never visible, or when another stop ended before the
  /// detection time.
  void undetected() {
    const auto& wanted = run_.expectation;
    if (wanted.reasons.empty() || wanted.may_ride_through || !run_.visible_ns || run_.rows.empty()) return;
    const Row& last = run_.rows.back();
    if (ms(*run_.visible_ns, last.time_ns) < wanted.detection_ms) return;
    for (const Row& row : run_.rows)
      if (row.time_ns >= run_.onset_ns && ms(*run_.visible_ns, row.time_ns) <= wanted.detection_ms &&
          is_stop(row.status.state) && commanded_closed(row) && no_volts(row))
        return;
    violated(Invariant::right_reason, run_.rows.size() - 1, "not detected");
  }

  void refusal() {
    if (run_.expectation.refused && (!run_.accepted || *run_.accepted))
      violated(Invariant::reset_and_arm, run_.rows.size() - 1,
               run_.accepted ? "a request was accepted that must be refused" : "a request was not answered");
  }

  /// Bridge and supervisor must each detect the fault, even when the other one has already stopped the crane.
  void independent_detection() {
    const auto& wanted = run_.expectation;
    if (wanted.bridge_must_latch != crane_LATCH_NONE &&
        !seen_in_time([&](const Row& row) { return row.state.latch_reason == wanted.bridge_must_latch; }))
      violated(Invariant::right_reason, run_.rows.size() - 1,
               "the bridge has not detected the fault by itself");
    if (wanted.supervisor_must_find != crane_CAUSE_NONE &&
        !seen_in_time([&](const Row& row) { return row.status.cause == wanted.supervisor_must_find; }))
      violated(Invariant::right_reason, run_.rows.size() - 1,
               "the supervisor has not detected the fault by itself");
  }

  /// @return true when a row shows the detection in time; also when the fault was never visible, or the run
  /// ended before the longest permitted time
  template <class Shows>
  [[nodiscard]] bool seen_in_time(const Shows& shows) const {
    const double bound_ms = run_.expectation.independent_ms + 1e-6;
    if (!run_.visible_ns || run_.rows.empty() || ms(*run_.visible_ns, run_.rows.back().time_ns) < bound_ms)
      return true;
    return std::any_of(
        run_.rows.begin() + static_cast<std::ptrdiff_t>(onset_), run_.rows.end(),
        [&](const Row& row) { return shows(row) && ms(*run_.visible_ns, row.time_ns) <= bound_ms; });
  }

  void nothing_outwards() {
    const auto& axis = run_.expectation.outwards_axis;
    if (!axis || !verdict_.first || verdict_.first->cause != crane_CAUSE_STOPPING_ENVELOPE) return;
    // The command of the tick of the detection acts from the next tick on.
    for (std::size_t k = first_row_ + 1; k < run_.rows.size(); ++k)
      if (run_.rows[k].truth.written_v[*axis] * run_.expectation.outwards > kVolt)
        violated(Invariant::zero_volts, k,
                 "a voltage outwards although the axis would not stop before its limit");
  }

  /// When the bridge has ended, only the relay of the rig closes the brakes.
  void relay_acts() {
    for (std::size_t k = onset_; k < run_.rows.size(); ++k)
      if (run_.rows[k].truth.brake_closed == present_brakes(run_.rows[k])) {
        if (ms(run_.onset_ns, run_.rows[k].time_ns) > run_.expectation.braked_by_rig_ms)
          violated(Invariant::brakes_commanded, k, "the relay closed the brakes late");
        return;
      }
    violated(Invariant::brakes_commanded, run_.rows.size() - 1, "the relay did not close the brakes");
  }

  void stop_times() {
    if (run_.expectation.volts_by_rig) relay_acts();
    if (!verdict_.first) return;
    const auto detected_ns = run_.rows[first_row_].time_ns;
    const auto since_ns = run_.visible_ns.value_or(run_.onset_ns);
    const bool controlled = is_controlled(*verdict_.first);
    std::optional<std::int64_t> zero_ns, commanded_ns;
    for (std::size_t k = first_row_; k < run_.rows.size(); ++k) {
      const Row& row = run_.rows[k];
      if (!zero_ns && no_volts(row) && (!controlled || commanded_closed(row))) zero_ns = row.time_ns;
      if (!commanded_ns && commanded_closed(row)) commanded_ns = row.time_ns;
      if (!verdict_.braked_ms && row.truth.brake_closed == present_brakes(row))
        verdict_.braked_ms = ms(since_ns, row.time_ns);
    }
    if (zero_ns) verdict_.zero_volts_ms = ms(since_ns, *zero_ns);
    const bool no_supervisor = run_.expectation.supervisor_gone || run_.expectation.supervisor_faulty;
    if (run_.expectation.volts_by_rig || (no_supervisor && !run_.expectation.communication)) return;
    const auto end_ns = run_.rows.back().time_ns;
    const double reaction_ms =
        (run_.expectation.loses_commands ? kCommunicationBound_ms : kZeroVoltsBound_ms) +
        run_.expectation.bridge_delay_ms;
    const double bound_ms = controlled ? kControlledStop_ms : reaction_ms;
    if (ms(detected_ns, zero_ns.value_or(end_ns)) > bound_ms + 1e-6)
      violated(Invariant::zero_volts, first_row_, "0 V comes late after the detection");
    if (run_.expectation.communication && !controlled &&
        ms(run_.onset_ns, zero_ns.value_or(end_ns)) > kCommunicationBound_ms + 1e-6)
      violated(Invariant::zero_volts, first_row_, "0 V comes late after the onset");
    // The supervisor runs its ramp to 0 V even when no voltage was applied.
    const bool late = ms(detected_ns, commanded_ns.value_or(end_ns)) > reaction_ms + 1e-6;
    if (zero_ns && late && ms(*zero_ns, commanded_ns.value_or(end_ns)) > kBrakesBound_ms + 1e-6)
      violated(Invariant::brakes_commanded, first_row_, "the brakes are commanded closed late");
  }

  [[nodiscard]] AxisFlags present_brakes(const Row& row) const {
    AxisFlags flags = row.truth.brake_closed;
    for (std::size_t i = 0; i < kAxes; ++i)
      if (rig_.drives[i].present) flags[i] = true;
    return flags;
  }

  const configuration::Rig& rig_;
  const Run& run_;
  Verdict verdict_;
  std::size_t onset_ = 0, first_row_ = 0;
};

}  // namespace

const char* name_of(Invariant invariant) noexcept {
  static constexpr std::array<const char*, kInvariants> kNames{
      "I1 inside hard limits", "I2 0 V in time",        "I3 brakes commanded closed",
      "I4 braked axes stay",   "I5 reset and arm",      "I6 supervisor's volts only",
      "I7 volts in range",     "I8 right first reason", "I9 recording recoverable",
      "I10 no false trip"};
  return kNames[static_cast<std::size_t>(invariant)];
}

Verdict judge(const configuration::Rig& rig, const Run& run) { return Judgement{rig, run}.take(); }

}  // namespace crane::campaign
