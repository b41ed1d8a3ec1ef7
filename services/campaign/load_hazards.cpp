/// Hazard 23: a load that swings too far.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// Detection time: 20 ms after the swing exceeds its limit.
Injection swing_limit(Bench& bench, Random& random) {
  auto due = swings_too_far(bench);
  push(bench, bench.setting().configured.limits.swing_limit_rad * random.between(1.15, 1.7));
  return {.expectation = {.reasons = {because(crane_CAUSE_SWING_LIMIT)}, .detection_ms = 20},
          .watched_s = 2,
          .visible = std::move(due)};
}

constexpr std::array kLoadHazards{Hazard{.number = 23, .name = "swing limit", .inject = swing_limit}};

}  // namespace

std::function<bool()> swings_too_far(const Bench& bench) {
  constexpr double kRunaway = 1.25;
  const bool stopping = bench.now().status.state == crane_STATE_STOP_C1;
  const double limit_rad = bench.setting().configured.limits.swing_limit_rad * (stopping ? kRunaway : 1);
  return [&bench, limit_rad] {
    const auto& truth = bench.now().truth;
    return std::max(std::abs(truth.swing_radial_rad), std::abs(truth.swing_tangential_rad)) > limit_rad;
  };
}

std::span<const Hazard> load_hazards() { return kLoadHazards; }

}  // namespace crane::campaign
