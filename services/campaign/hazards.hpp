#pragma once
/// The hazards of docs/safety.md, each as something that happens to a crane on the test bench, and what has
/// to come of it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <span>

#include "campaign/bench.hpp"

namespace crane::campaign {

/// Decides everything about one run that its tuple leaves open.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_{seed} {}
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

/// Where a hazard can be made to happen.
enum class Place : std::uint8_t { campaign, process, hardware };

struct Strike {
  Expectation expectation{};
  double watched_s = 1;             ///< after the onset
  std::function<bool()> visible{};  ///< whether its effect can be seen by now; empty: from the onset on
};

struct Hazard {
  int number;  ///< 1 to 31: docs/safety.md; from 32 on what an operator asks for
  const char* name;
  Place place = Place::campaign;
  const char* elsewhere = "";  ///< where it is proved instead, for a place that is not the campaign
  std::uint64_t every = 1;     ///< only every n-th seed: a run takes long
  bool from_power_on = false;  ///< strikes before anything has been asked for, whatever the moment
  /// Changes the rig before anything is built; null: nothing. Runs with it share no preparation with others.
  void (*prepare)(Setting&, Dice&) = nullptr;
  /// At the moment. It may let requests take effect first: the onset is the tick after it returns.
  Strike (*strike)(Bench&, Dice&) = nullptr;
};

[[nodiscard]] std::span<const Hazard> hazards();
/// @return null when there is none of that number
[[nodiscard]] const Hazard* find_hazard(int number);

// A file for each kind.
[[nodiscard]] std::span<const Hazard> process_hazards();
[[nodiscard]] std::span<const Hazard> encoder_hazards();
[[nodiscard]] std::span<const Hazard> drive_hazards();
[[nodiscard]] std::span<const Hazard> load_hazards();
[[nodiscard]] std::span<const Hazard> brake_hazards();
[[nodiscard]] std::span<const Hazard> mad_supervisor_hazards();
[[nodiscard]] std::span<const Hazard> request_hazards();
[[nodiscard]] std::span<const Hazard> start_hazards();

/// The side to which the setting moves the axis of the fault.
[[nodiscard]] double direction(const Bench& bench);
/// A change of a coordinate as its counter shows it.
[[nodiscard]] std::int32_t counts(const Bench& bench, std::size_t counter, double change);
/// The counter that feels the motion of the axis most: radial for trolley and hoist, tangential for the jib.
[[nodiscard]] std::size_t swing_counter(const Bench& bench);
/// From now on the counter stands.
void freeze(Bench& bench, std::size_t counter);
/// The counter has left the truth by more than `error`, m or rad.
[[nodiscard]] std::function<bool()> sees_error(Bench& bench, std::size_t counter, double error);
/// A push against the load that swings it so far. @param rad  amplitude
void push(Bench& bench, double rad);
/// The swing asks for a stop: beyond its limit, and in a controlled stop, which damps it anyway, beyond 1.25
/// times its limit.
[[nodiscard]] std::function<bool()> swings_too_far(const Bench& bench);
/// A limit switch closes where the counter says there is none.
[[nodiscard]] Strike switch_elsewhere(Bench& bench, Dice& dice);
/// The truth is beyond the limit that the reason names.
[[nodiscard]] std::function<bool()> crosses(Bench& bench, Reason reason);
inline constexpr double kClear_s =
    1.2;  ///< longer than the second for which causes have to be clear before a reset
/// The newest request is to be refused.
[[nodiscard]] Strike refusal();
/// The operator's emergency stop, until the axes stand.
void stop_at_once(Bench& bench);
/// What the bridge may say first when a drive or an encoder does not do what it should.
[[nodiscard]] std::vector<Reason> drive_reasons();

[[nodiscard]] inline Reason because(crane_Cause cause) { return {cause, crane_LATCH_NONE}; }
[[nodiscard]] inline Reason latched(crane_LatchReason reason) { return {crane_CAUSE_BRIDGE_LATCHED, reason}; }

}  // namespace crane::campaign
