/// Hazards 14 to 18: encoders of axes and of the swing.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// The counter runs over its end within the move, where the move leads away from 0.
void fine_encoders(Setting& setting, Dice& dice) {
  constexpr double kHalfRange = 1 << 23;
  const std::size_t i = setting.axis;
  const double start = setting.told.start.position[i], target = setting.target[i];
  if (std::abs(target) <= std::abs(start) + 0.1) return;
  const double at = start + dice.between(0.3, 0.7) * (target - start);
  if (std::abs(at) <= std::abs(start)) return;
  setting.told.encoders[i].counts_per_unit = setting.wired.encoders[i].counts_per_unit =
      kHalfRange / std::abs(at);
}

Strike nothing_at_all(Bench& /*bench*/, Dice& /*dice*/) { return {.expectation = {}, .watched_s = 2}; }

void shift_counter(Bench& bench, std::size_t counter, std::int32_t by) {
  bench.world().spoil_inputs = [counter, by](bridge::Inputs& inputs) {
    inputs.raw_counts[counter] = simulator::wrap_24_bit(std::int64_t{inputs.raw_counts[counter]} + by);
  };
}

/// The whole speed that the jump makes of the axis' own is `ratio` of its largest.
void jump_to_speed(Bench& bench, double ratio) {
  const std::size_t i = bench.axis();
  const auto& told = bench.setting().told;
  const double v = bench.now().truth.speed[i];
  const double side = v != 0 ? std::copysign(1, v) : direction(bench);
  const double jump = (ratio * told.drives[i].max_speed - std::abs(v)) * told.period_s;
  shift_counter(bench, i, counts(bench, i, side * jump));
}

Strike encoder_jump(Bench& bench, Dice& dice) {
  std::vector<Reason> reasons{latched(crane_LATCH_ENCODER_JUMP)};
  switch (dice.pick(4)) {
    case 0:
      shift_counter(bench, swing_counter(bench),
                    counts(bench, swing_counter(bench), dice.sign() * dice.between(0.4, 1)));
      break;
    case 1:
      jump_to_speed(bench, dice.between(1.2, 1.9));
      reasons = {latched(crane_LATCH_SPEED), latched(crane_LATCH_POSITION)};
      break;
    case 2:
      jump_to_speed(bench, dice.between(1.03, 1.07));
      reasons = {because(crane_CAUSE_OVERSPEED), latched(crane_LATCH_POSITION)};
      break;
    default:
      jump_to_speed(bench, dice.between(2.3, 40));
  }
  return {.expectation = {.reasons = reasons, .detection_ms = 10}};
}

/// Due: 100 ms (hazard 16) after its speed cannot be explained any more (evidence.hpp). The load swings
/// because of an acceleration that the encoder does not show, so that the check of the swing encoders may be
/// the first.
Strike encoder_frozen(Bench& bench, Dice& /*dice*/) {
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

/// The counter misses a share of the way. Within the tolerances of the model nothing but a switch can tell:
/// due one tick after the axis has reached it. The axis is then beyond its hard limit by what its brake
/// needs.
Strike lost_counts(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const double kept = dice.between(0.85, 0.97);
  const auto first = static_cast<double>(bench.world().board().read().raw_counts[i]);
  bench.world().spoil_inputs = [i, kept, first](bridge::Inputs& inputs) {
    inputs.raw_counts[i] =
        static_cast<std::int32_t>(std::lround(first + kept * (inputs.raw_counts[i] - first)));
  };
  return {.expectation = {.reasons = {latched(crane_LATCH_LOST_COUNTS), because(crane_CAUSE_LIMIT_SWITCH)},
                          .detection_ms = 10,
                          .position_is_false = true},
          .watched_s = 1.5,
          .visible = [&bench, i] {
            const auto inputs = bench.world().board().read();
            return inputs.limit_low[i] || inputs.limit_high[i];
          }};
}

Strike counts_wrong(Bench& bench, Dice& dice) {
  return dice.pick(3) == 0 ? switch_elsewhere(bench, dice) : lost_counts(bench, dice);
}

/// Due after the imbalance that a standing encoder shows is visible (evidence.hpp): four samples of the mean,
/// two of a speed, and ten for a push that is forgiven once.
constexpr double kSwingDetection_ms = 160;

Strike swing_encoder(Bench& bench, Dice& dice) {
  const std::size_t counter = swing_counter(bench);
  auto at = std::make_shared<std::optional<std::int32_t>>();
  auto noise = std::make_shared<Dice>(dice.pick(1U << 30U));
  const auto shake = static_cast<double>(counts(bench, counter, 0.08));
  const auto kind = dice.pick(4);
  bench.world().spoil_inputs = [=](bridge::Inputs& inputs) {
    auto& shown = inputs.raw_counts[counter];
    if (!*at) *at = shown;
    if (kind == 0) shown = **at;
    if (kind == 1) shown = 0;
    if (kind == 2) shown += static_cast<std::int32_t>(std::lround(noise->between(-shake, shake)));
    if (kind == 3) shown = -shown;
  };
  Strike strike{
      .expectation = {.reasons = {because(crane_CAUSE_SWING_SENSOR), latched(crane_LATCH_ENCODER_JUMP)},
                      .detection_ms = kSwingDetection_ms},
      .watched_s = 2};
  // Noise is seen at once. A mirrored swing fulfils the same equations until the trolley moves it, and has no
  // due time.
  if (kind < 2)
    strike.visible = [zero = kind == 1, evidence = std::make_shared<SwingEvidence>(bench, counter)] {
      return evidence->of_standing_encoder(zero ? 0 : evidence->swing_at_first());
    };
  if (kind == 3) strike.visible = [] { return false; };
  return strike;
}

constexpr std::array kOfEncoders{
    Hazard{.number = 14, .name = "encoder counter wraps", .prepare = fine_encoders, .strike = nothing_at_all},
    Hazard{.number = 15, .name = "encoder jumps", .strike = encoder_jump},
    Hazard{.number = 16, .name = "encoder frozen", .strike = encoder_frozen},
    Hazard{.number = 17, .name = "lost counts", .strike = counts_wrong},
    Hazard{.number = 18, .name = "swing encoder fails", .strike = swing_encoder},
};

}  // namespace

std::span<const Hazard> encoder_hazards() { return kOfEncoders; }

}  // namespace crane::campaign
