/// Hazards 19 to 22 and 44: faulty drives, and demands beyond a limit.
#include "campaign/evidence.hpp"
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

/// The detection time starts when the unexplained speed is visible (evidence.hpp).
Injection drive_fault(Bench& bench, double detection_ms) {
  return {.expectation = {.reasons = drive_reasons(), .detection_ms = detection_ms},
          .watched_s = 2,
          .visible = [evidence = std::make_shared<Evidence>(bench, bench.axis())] {
            return evidence->of_drive();
          }};
}

/// Converter stuck at its present voltage or at another one, or with the wrong sign.
Injection converter(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const auto kind = random.pick(3);
  const double stuck_v = kind == 0
                             ? bench.now().truth.converter_v[i] * bench.setting().configured.drives[i].sign
                             : random.sign() * random.between(6, 10);
  bench.rig().change_outputs = [i, kind, stuck_v](bridge::Outputs& outputs) {
    outputs.drive_v[i] = kind == 2 ? -outputs.drive_v[i] : stuck_v;
  };
  return drive_fault(bench, kEncoderDetection_ms);
}

/// Drive without voltage, with an offset, or with twice the voltage.
Injection weak_drive(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const auto kind = random.pick(3);
  const double offset_v = random.sign() * random.between(3, 5);
  bench.rig().change_outputs = [i, kind, offset_v](bridge::Outputs& outputs) {
    if (kind == 0) outputs.drive_v[i] = 0;
    if (kind == 1) outputs.drive_v[i] += offset_v;
    if (kind == 2) outputs.drive_v[i] *= 2;
  };
  return drive_fault(bench, kDriveDetection_ms);
}

/// A controller that demands a constant voltage. Detection time: one tick after overspeed (hazard 21: 20 ms).
Injection overspeed(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const double volts_v = direction(bench) * random.between(7, 10);
  bench.publish_fault =
      falsify(topics::demand, [i, volts_v](msg::Demand& demand) { demand.total_v[i] = volts_v; });
  return {.expectation = {.reasons = {because(crane_CAUSE_OVERSPEED)}, .detection_ms = 20},
          .watched_s = 3,
          .visible = crosses_limit(bench, because(crane_CAUSE_OVERSPEED))};
}

/// Detection time: 10 ms after the axis can no longer stop before its limit.
Injection position_limit(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const double volts_v = direction(bench) * random.between(3, 5);
  bench.publish_fault =
      falsify(topics::demand, [i, volts_v](msg::Demand& demand) { demand.total_v[i] = volts_v; });
  return {.expectation = {.reasons = {because(crane_CAUSE_STOPPING_ENVELOPE)},
                          .detection_ms = 10,
                          .outwards_axis = i,
                          .outwards = direction(bench)},
          .watched_s = 4,
          .visible = crosses_limit(bench, because(crane_CAUSE_STOPPING_ENVELOPE))};
}

/// One demand beyond the range of the drive, against the motion, as a controller may publish it. The gate
/// limits the demand; the crane must not stop.
Injection beyond_the_range(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const double volts_v = -direction(bench) * random.between(12, 60);
  bench.publish_fault = falsify(topics::demand, [i, volts_v, tick = 0](msg::Demand& demand) mutable {
    if (tick++ < 2) demand.total_v[i] = volts_v;
  });
  return {.expectation = {}, .watched_s = 0.3};
}

constexpr std::array kDriveHazards{
    Hazard{.number = 19, .name = "converter stuck, wrong sign", .inject = converter},
    Hazard{.number = 20, .name = "following error", .inject = weak_drive},
    Hazard{.number = 21, .name = "overspeed", .inject = overspeed},
    Hazard{.number = 22, .name = "position limit", .inject = position_limit},
    Hazard{.number = 44, .name = "demand beyond the range of a drive", .inject = beyond_the_range},
};

}  // namespace

std::span<const Hazard> drive_hazards() { return kDriveHazards; }

}  // namespace crane::campaign
