/// Hazards 19 to 22: drives that do something else, and demands that lead beyond a limit.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// Due as the speed that nothing explains becomes visible (evidence.hpp).
Strike drive_strike(Bench& bench, double detection_ms) {
  return {.expectation = {.reasons = drive_reasons(), .detection_ms = detection_ms},
          .watched_s = 2,
          .visible = [evidence = std::make_shared<Evidence>(bench, bench.axis())] {
            return evidence->of_drive();
          }};
}

/// Stuck where it is, at the end of its range, or the wrong sign.
Strike converter(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const auto kind = dice.pick(3);
  const double stuck_v = kind == 0 ? bench.now().truth.converter_v[i] * bench.setting().told.drives[i].sign
                                   : dice.sign() * dice.between(6, 10);
  bench.world().spoil_outputs = [i, kind, stuck_v](bridge::Outputs& outputs) {
    outputs.drive_v[i] = kind == 2 ? -outputs.drive_v[i] : stuck_v;
  };
  return drive_strike(bench, kEncoderDetection_ms);
}

/// A drive that gives a part of what it is told, or that much more.
Strike weak_drive(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const auto kind = dice.pick(3);
  const double offset_v = dice.sign() * dice.between(3, 5);
  bench.world().spoil_outputs = [i, kind, offset_v](bridge::Outputs& outputs) {
    if (kind == 0) outputs.drive_v[i] = 0;
    if (kind == 1) outputs.drive_v[i] += offset_v;
    if (kind == 2) outputs.drive_v[i] *= 2;
  };
  return drive_strike(bench, kDriveDetection_ms);
}

/// A controller that knows one voltage only. Due: one tick after the axis is too fast (hazard 21: 20 ms).
Strike overspeed(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const double volts_v = direction(bench) * dice.between(7, 10);
  bench.mad = madness(topics::demand, [i, volts_v](msg::Demand& demand) { demand.total_v[i] = volts_v; });
  return {.expectation = {.reasons = {because(crane_CAUSE_OVERSPEED)}, .detection_ms = 20},
          .watched_s = 3,
          .visible = crosses(bench, because(crane_CAUSE_OVERSPEED))};
}

/// Due: 10 ms after the axis would not stop before its limit any more.
Strike position_limit(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const double volts_v = direction(bench) * dice.between(3, 5);
  bench.mad = madness(topics::demand, [i, volts_v](msg::Demand& demand) { demand.total_v[i] = volts_v; });
  return {.expectation = {.reasons = {because(crane_CAUSE_STOPPING_ENVELOPE)},
                          .detection_ms = 10,
                          .outwards_axis = i,
                          .outwards = direction(bench)},
          .watched_s = 4,
          .visible = crosses(bench, because(crane_CAUSE_STOPPING_ENVELOPE))};
}

/// One demand beyond the range of the drive, against the motion, as a controller may make it: it is
/// saturated, and no reason to stop.
Strike beyond_the_range(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const double volts_v = -direction(bench) * dice.between(12, 60);
  bench.mad = madness(topics::demand, [i, volts_v, tick = 0](msg::Demand& demand) mutable {
    if (tick++ < 2) demand.total_v[i] = volts_v;
  });
  return {.expectation = {}, .watched_s = 0.3};
}

constexpr std::array kOfDrives{
    Hazard{.number = 19, .name = "converter stuck, wrong sign", .strike = converter},
    Hazard{.number = 20, .name = "following error", .strike = weak_drive},
    Hazard{.number = 21, .name = "overspeed", .strike = overspeed},
    Hazard{.number = 22, .name = "position limit", .strike = position_limit},
    Hazard{.number = 44, .name = "demand beyond the range of a drive", .strike = beyond_the_range},
};

}  // namespace

std::span<const Hazard> drive_hazards() { return kOfDrives; }

}  // namespace crane::campaign
