/// Hazards 14 to 18: encoders of axes and of the swing.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// Sets the resolution such that the counter wraps during a move away from 0.
void fine_encoders(Setting& setting, Random& random) {
  constexpr double kHalfRange = 1 << 23;
  const std::size_t i = setting.axis;
  const double start = setting.configured.start.position[i], target = setting.target[i];
  if (std::abs(target) <= std::abs(start) + 0.1) return;
  const double at = start + random.between(0.3, 0.7) * (target - start);
  if (std::abs(at) <= std::abs(start)) return;
  setting.configured.encoders[i].counts_per_unit = setting.actual.encoders[i].counts_per_unit =
      kHalfRange / std::abs(at);
}

Injection nothing_at_all(Bench& /*bench*/, Random& /*random*/) { return {.expectation = {}, .watched_s = 2}; }

void shift_counter(Bench& bench, std::size_t counter, std::int32_t by) {
  bench.rig().change_inputs = [counter, by](bridge::Inputs& inputs) {
    inputs.raw_counts[counter] = simulator::wrap_24_bit(std::int64_t{inputs.raw_counts[counter]} + by);
  };
}

/// Shifts the counter such that the encoder shows `ratio` times the largest speed of the axis for one tick.
void jump_to_speed(Bench& bench, double ratio) {
  const std::size_t i = bench.axis();
  const auto& configured = bench.setting().configured;
  const double v = bench.now().truth.speed[i];
  const double side = v != 0 ? std::copysign(1, v) : direction(bench);
  const double jump = (ratio * configured.drives[i].max_speed - std::abs(v)) * configured.period_s;
  shift_counter(bench, i, counts(bench, i, side * jump));
}

Injection encoder_jump(Bench& bench, Random& random) {
  std::vector<Reason> reasons{latched(crane_LATCH_ENCODER_JUMP)};
  switch (random.pick(4)) {
    case 0:
      shift_counter(bench, swing_counter(bench),
                    counts(bench, swing_counter(bench), random.sign() * random.between(0.4, 1)));
      break;
    case 1:
      jump_to_speed(bench, random.between(1.2, 1.9));
      reasons = {latched(crane_LATCH_SPEED), latched(crane_LATCH_POSITION)};
      break;
    case 2:
      jump_to_speed(bench, random.between(1.03, 1.07));
      reasons = {because(crane_CAUSE_OVERSPEED), latched(crane_LATCH_POSITION)};
      break;
    default:
      jump_to_speed(bench, random.between(2.3, 40));
  }
  return {.expectation = {.reasons = reasons, .detection_ms = 10}};
}

/// Detection time: 100 ms (hazard 16) after the speed can no longer be explained (evidence.hpp). The load
/// swings because of an acceleration that the encoder does not show, so that the check of the swing encoders
/// may detect the fault first.
Injection encoder_frozen(Bench& bench, Random& /*random*/) {
  const std::size_t i = bench.axis();
  freeze(bench, i);
  return {
      .expectation = {.reasons = {latched(crane_LATCH_ENCODER_FROZEN), because(crane_CAUSE_FOLLOWING_ERROR),
                                  because(crane_CAUSE_SWING_SENSOR)},
                      .detection_ms = kEncoderDetection_ms},
      .watched_s = 2,
      .visible = [evidence = std::make_shared<Evidence>(bench, i)] {
        return evidence->of_standing_encoder();
      }};
}

/// The counter loses a share of the motion. Within the tolerances of the model only a limit switch can detect
/// this: detection time is one tick after the axis reaches the switch. The axis may then move beyond its hard
/// limit by its stopping distance.
Injection lost_counts(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const double kept = random.between(0.85, 0.97);
  const auto first = static_cast<double>(bench.rig().board().read().raw_counts[i]);
  bench.rig().change_inputs = [i, kept, first](bridge::Inputs& inputs) {
    inputs.raw_counts[i] =
        static_cast<std::int32_t>(std::lround(first + kept * (inputs.raw_counts[i] - first)));
  };
  return {.expectation = {.reasons = {latched(crane_LATCH_LOST_COUNTS), because(crane_CAUSE_LIMIT_SWITCH)},
                          .detection_ms = 10,
                          .position_is_wrong = true},
          .watched_s = 1.5,
          .visible = [&bench, i] {
            const auto inputs = bench.rig().board().read();
            return inputs.limit_low[i] || inputs.limit_high[i];
          }};
}

Injection counts_wrong(Bench& bench, Random& random) {
  return random.pick(3) == 0 ? switch_at_wrong_position(bench, random) : lost_counts(bench, random);
}

/// Detection time from the visibility of a frozen swing encoder (SwingEvidence): four samples for the mean,
/// two for a speed, ten for one tolerated push of the load.
constexpr double kSwingDetection_ms = 160;

Injection swing_encoder(Bench& bench, Random& random) {
  const std::size_t counter = swing_counter(bench);
  auto at = std::make_shared<std::optional<std::int32_t>>();
  auto noise = std::make_shared<Random>(random.pick(1U << 30U));
  const auto shake = static_cast<double>(counts(bench, counter, 0.08));
  const auto kind = random.pick(4);
  bench.rig().change_inputs = [=](bridge::Inputs& inputs) {
    auto& shown = inputs.raw_counts[counter];
    if (!*at) *at = shown;
    if (kind == 0) shown = **at;
    if (kind == 1) shown = 0;
    if (kind == 2) shown += static_cast<std::int32_t>(std::lround(noise->between(-shake, shake)));
    if (kind == 3) shown = -shown;
  };
  Injection injection{
      .expectation = {.reasons = {because(crane_CAUSE_SWING_SENSOR), latched(crane_LATCH_ENCODER_JUMP)},
                      .detection_ms = kSwingDetection_ms},
      .watched_s = 2};
  // Noise is visible at once. A swing with the wrong sign fulfils the same equations until the trolley moves,
  // and has no detection time.
  if (kind < 2)
    injection.visible = [zero = kind == 1, evidence = std::make_shared<SwingEvidence>(bench, counter)] {
      return evidence->of_standing_encoder(zero ? 0 : evidence->swing_at_first());
    };
  if (kind == 3) injection.visible = [] { return false; };
  return injection;
}

constexpr std::array kEncoderHazards{
    Hazard{.number = 14, .name = "encoder counter wraps", .prepare = fine_encoders, .inject = nothing_at_all},
    Hazard{.number = 15, .name = "encoder jumps", .inject = encoder_jump},
    Hazard{.number = 16, .name = "encoder frozen", .inject = encoder_frozen},
    Hazard{.number = 17, .name = "lost counts", .inject = counts_wrong},
    Hazard{.number = 18, .name = "swing encoder fails", .inject = swing_encoder},
};

}  // namespace

std::span<const Hazard> encoder_hazards() { return kEncoderHazards; }

}  // namespace crane::campaign
