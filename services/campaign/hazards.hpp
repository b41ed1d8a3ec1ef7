#pragma once
/// The hazards of docs/campaign.md. Each hazard injects a fault on the test bench and states the expected
/// reaction.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <span>

#include "campaign/bench.hpp"

namespace crane::campaign {

/// Random choices of one run. The seed comes from the tuple.
class Random {
 public:
  explicit Random(std::uint64_t seed) : random_{seed} {}
  [[nodiscard]] std::size_t pick(std::size_t count) { return random_() % count; }
  [[nodiscard]] double between(double low, double high) {
    constexpr double kRange = 9007199254740992;  // 2^53: the same on every standard library
    return low + (high - low) * static_cast<double>(random_() >> 11U) / kRange;
  }
  [[nodiscard]] bool chance(double probability) { return between(0, 1) < probability; }
  [[nodiscard]] double sign() { return pick(2) == 0 ? -1 : 1; }

 private:
  std::mt19937_64 random_;
};

/// Test bed of a hazard.
enum class TestBed : std::uint8_t {
  campaign,  ///< simulated crane in virtual time: this library
  process,   ///< tests with real processes or files
  hardware   ///< a real rig only
};

struct Injection {
  Expectation expectation{};
  double watched_s = 1;  ///< duration of the observation after the onset
  /// Returns true when the effect of the fault is visible; empty: visible from the onset on.
  std::function<bool()> visible{};
};

struct Hazard {
  int number;  ///< docs/campaign.md refers to it
  const char* name;
  TestBed test_bed = TestBed::campaign;
  const char* verified_by = "";  ///< test that verifies the hazard on another test bed than the campaign
  std::uint64_t every = 1;       ///< n: only every n-th seed runs, because a run takes long
  bool from_power_on = false;    ///< true: the fault acts from power-on, independent of the moment
  /// Changes the rig before the stack starts; null: no change. The preparation of such a run is not shared
  /// with another run.
  void (*prepare)(Setting&, Random&) = nullptr;
  /// Injects the fault at the moment. The function may run ticks, to send requests; the onset is
  /// the first tick after its return.
  Injection (*inject)(Bench&, Random&) = nullptr;
};

[[nodiscard]] std::span<const Hazard> hazards();
/// @return null when no hazard has this number
[[nodiscard]] const Hazard* find_hazard(int number);

// One source per group.
[[nodiscard]] std::span<const Hazard> process_hazards();
[[nodiscard]] std::span<const Hazard> sample_hazards();
[[nodiscard]] std::span<const Hazard> encoder_hazards();
[[nodiscard]] std::span<const Hazard> drive_hazards();
[[nodiscard]] std::span<const Hazard> load_hazards();
[[nodiscard]] std::span<const Hazard> brake_hazards();
[[nodiscard]] std::span<const Hazard> faulty_supervisor_hazards();
[[nodiscard]] std::span<const Hazard> request_hazards();
[[nodiscard]] std::span<const Hazard> start_hazards();

/// Sign of the move of the setting on the axis of the fault: 1 or -1.
[[nodiscard]] double direction(const Bench& bench);
/// Converts a change of a coordinate, m or rad, to encoder counts.
[[nodiscard]] std::int32_t counts(const Bench& bench, std::size_t counter, double change);
/// Counter of the swing that the motion of the axis causes: radial for trolley and hoist, tangential for the
/// jib.
[[nodiscard]] std::size_t swing_counter(const Bench& bench);
/// Freezes the counter.
void freeze(Bench& bench, std::size_t counter);
/// True when the error of the counter exceeds `error`, m or rad.
[[nodiscard]] std::function<bool()> sees_error(Bench& bench, std::size_t counter, double error);
/// Pushes the load so that it swings with the amplitude `rad` in rad.
void push(Bench& bench, double rad);
/// True when the swing requires a stop: above its limit; in a controlled stop, which damps the swing, above
/// 1.25 times its limit.
[[nodiscard]] std::function<bool()> swings_too_far(const Bench& bench);
/// A limit switch is pressed at a wrong position of the axis.
[[nodiscard]] Injection switch_at_wrong_position(Bench& bench, Random& random);
/// True when the true state is beyond the limit that the reason names.
[[nodiscard]] std::function<bool()> crosses_limit(Bench& bench, Reason reason);
/// Longer than the 1 s for which all causes must be inactive before a reset.
inline constexpr double kClear_s = 1.2;
/// Expects that the newest request is refused.
[[nodiscard]] Injection refusal();
/// Sends the operator's emergency stop and waits until the axes are at rest.
void emergency_stop(Bench& bench);
/// Reasons that may be reported first for a faulty drive or encoder.
[[nodiscard]] std::vector<Reason> drive_reasons();

/// Expectations when a process misses every sample of a topic.
[[nodiscard]] Injection lost_demand(double watched_s = 1);
[[nodiscard]] Injection lost_command();
/// The supervisor counts missing states, the bridge counts missing commands; the phase decides which of them
/// detects the fault first.
[[nodiscard]] Injection lost_state();
/// Expects that the crane continues.
[[nodiscard]] Injection nothing();

[[nodiscard]] inline Reason because(crane_Cause cause) { return {cause, crane_LATCH_NONE}; }
[[nodiscard]] inline Reason latched(crane_LatchReason reason) { return {crane_CAUSE_BRIDGE_LATCHED, reason}; }

}  // namespace crane::campaign
