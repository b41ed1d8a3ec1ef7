/// Refuses values that no crane has: each bound is far beyond the values of cranes, so that a value outside
/// it is a mistake of unit or of typing. rig_document.cpp prints implausible_values().
#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/control/controlled_stop.hpp"
#include "crane/fields/shortest.hpp"
#include "crane/plant/pendulum.hpp"
#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

using fields::shortest;

/// Turns of the slew axis to each side. The slewing limiter of a tower crane permits about 1.5 turns; 180
/// degrees that are entered as radians are 29 turns.
constexpr double kMostTurns = 20;
constexpr double kMostAngle_rad = kMostTurns * 2 * std::numbers::pi;
/// m/s² or rad/s²: servo axes with linear motors reach 200 m/s²; a small servo motor without a load reaches
/// 2000 rad/s².
constexpr double kMostAcceleration = 5000;
/// m/s: the fastest mine hoists reach 20 m/s.
constexpr double kMostCableSpeed_mps = 100;
/// Share of the error that a sampled loop can correct in one tick: above 2 the next error is larger.
constexpr double kMostCorrection = 2;
/// Counts of the swing encoder up to the swing limit: a load at rest between two counts shows one of them.
constexpr double kLeastSwingCounts = 2;
/// s: an operator reacts to a light after about 0.25 s.
constexpr double kLeastIdle_s = 0.5;

std::string at_most(double bound, std::string_view unit) {
  return "must be at most " + shortest(bound) + " " + std::string{unit};
}

/// A gain is refused by the effect of the largest voltage.
void check_gain(TomlTable& table, std::string_view key, double gain, double volts, double most,
                std::string_view unit) {
  if (!(gain * volts > most) || !table.has(key)) return;
  table.problem(key, "times volt_limit_v (" + shortest(volts) + " V) " + at_most(most, unit) +
                         ": is the gain in SI units per volt?");
}

}  // namespace

void check_plausible_drive(TomlTable& table, const plant::Coordinate& axis, const Drive& drive) {
  const auto limit = [&axis](std::string_view key) { return key_in(control::kDriveLimitFields, key, axis); };
  const std::string unit{axis.unit};
  if (unit == "rad") {
    for (const auto& [key, angle_rad] :
         {std::pair{"low_limit", drive.low_limit}, std::pair{"high_limit", drive.high_limit}})
      if (std::abs(angle_rad) > kMostAngle_rad)
        table.problem(limit(key), "must be at most " + shortest(kMostTurns) + " turns (" +
                                      shortest(std::round(10 * kMostAngle_rad) / 10) +
                                      " rad) from 0: are these degrees?");
  }
  if (drive.brake_deceleration > kMostAcceleration)
    table.problem(limit("brake_deceleration"), at_most(kMostAcceleration, unit + "/s²") +
                                                   ": no brake of a crane is stronger; is the unit right?");
  if (const double least_vps = drive.volt_limit_v / control::kControlledStop_s;
      drive.volt_rate_limit_vps < least_vps)
    table.problem(limit("volt_rate_limit_vps"),
                  "must be at least " + shortest(least_vps) +
                      " V/s: the voltage must be able to return to 0 within the " +
                      shortest(control::kControlledStop_s) + " s of a controlled stop; is this V per tick?");
}

void check_plausible_gains(TomlTable& table, const plant::Parameters& crane, const Rig& rig) {
  const auto volts = [&rig](plant::Axis axis) { return rig.drives[axis].volt_limit_v; };
  check_gain(table, "trolley_gain_mps2pv", crane.trolley_gain_mps2pv, volts(plant::kTrolley),
             kMostAcceleration, "m/s²");
  check_gain(table, "slew_gain_radps2pv", crane.slew_gain_radps2pv, volts(plant::kSlew), kMostAcceleration,
             "rad/s²");
  check_gain(table, "hoist_gain_mpspv", crane.hoist_gain_mpspv, volts(plant::kHoist), kMostCableSpeed_mps,
             "m/s");
}

void check_plausible_loops(TomlTable& table, const control::Design& design) {
  const double load_period_s =
      plant::swing_period_s(design.crane.gravity_mps2, std::max(design.cable_length_m, 0.0));
  const auto check = [&](std::string_view key, double rate_ps, const std::string& loop) {
    const double corrected = rate_ps * design.period_s;
    if (!(corrected > kMostCorrection) || !std::isfinite(corrected)) return;
    table.problem(key, "must be lower: " + loop + " would correct " +
                           shortest(std::ceil(10 * corrected) / 10) +
                           " times the error in one tick, and more than " + shortest(kMostCorrection) +
                           " times makes the error grow");
  };
  const std::string_view derivative =
      table.has("tracking_derivative") ? "tracking_derivative" : "tracking_proportional";
  check(derivative, design.tracking_derivative / load_period_s, "the speed loop");
  check("hoist_proportional_ps", design.hoist_proportional_ps, "the cable loop");
}

void check_plausible_limits(TomlTable& table, const Rig& rig) {
  const control::OperatingLimits& limits = rig.limits;
  for (const std::size_t swing : {plant::kSwingRadial, plant::kSwingTangential}) {
    if (!rig.measures(swing)) continue;
    const double least_rad = kLeastSwingCounts / rig.encoders[swing].counts_per_unit;
    if (limits.swing_limit_rad < least_rad)
      table.problem("swing_limit_rad", "must be at least " + shortest(least_rad) + " rad, " +
                                           shortest(kLeastSwingCounts) + " counts of [encoder." +
                                           plant::kCoordinates[swing].name +
                                           "]: the encoder must show the swing before it exceeds the limit");
  }
  if (limits.idle_lock_s > 0 && limits.idle_lock_s < kLeastIdle_s)
    table.problem("idle_lock_s", "must be at least " + shortest(kLeastIdle_s) +
                                     " s: an operator needs this time to request a move before the crane "
                                     "locks");
}

void check_repeated_term(TomlTable& table, const std::vector<plant::TermSetting>& earlier,
                         const plant::TermSetting& term) {
  // The other terms are corrections, which crane diagnose appends: two of one name add up on purpose.
  if (term.name != "drive_friction") return;
  const auto same = [&term](const plant::TermSetting& other) {
    return other.name == term.name && other.axis == term.axis;
  };
  if (std::any_of(earlier.begin(), earlier.end(), same))
    table.problem("name",
                  "must not be repeated: an earlier term has this name and axis, and the two "
                  "frictions would add up");
}

std::string implausible_values() {
  const std::string acceleration = shortest(kMostAcceleration);
  return "| key | accepted | reason |\n|---|---|---|\n"
         "| `low_limit_rad`, `high_limit_rad` | at most " +
         shortest(kMostTurns) +
         " turns from 0 | the slewing limiter of a tower crane, which protects the cables to the jib, "
         "permits "
         "about 1.5 turns; a larger value is usually in degrees |\n"
         "| `trolley_gain_mps2pv`, `slew_gain_radps2pv` | times `volt_limit_v` at most " +
         acceleration +
         " m/s² or rad/s² | linear motors reach 200 m/s², small servo motors without a load 2000 rad/s² |\n"
         "| `hoist_gain_mpspv` | times `volt_limit_v` at most " +
         shortest(kMostCableSpeed_mps) +
         " m/s | mine hoists reach 20 m/s |\n"
         "| `brake_deceleration` | at most " +
         acceleration +
         " m/s² or rad/s² | as for the motor |\n"
         "| `volt_rate_limit_vps` | at least `volt_limit_v` / " +
         shortest(control::kControlledStop_s) + " s | a controlled stop, which lasts at most " +
         shortest(control::kControlledStop_s) +
         " s, must be able to end with 0 V |\n"
         "| `tracking_derivative` | `tracking_derivative` `period_s` / T at most " +
         shortest(kMostCorrection) +
         " | T is the period of the load at `cable_length_m` of the controller; the sampled speed loop "
         "corrects this share of the error in one tick, and diverges above 2 |\n"
         "| `hoist_proportional_ps` | times `period_s` at most " +
         shortest(kMostCorrection) +
         " | the same for the cable loop |\n"
         "| `swing_limit_rad` | at least " +
         shortest(kLeastSwingCounts) +
         " counts of each swing encoder | the encoder must show the swing before it exceeds the limit |\n"
         "| `idle_lock_s` | at least " +
         shortest(kLeastIdle_s) +
         " s | an operator needs this time to request a move |\n"
         "| `[[model.terms]]` | one `drive_friction` per axis | it states the whole friction of the drive; "
         "two "
         "entries would add up |\n";
}

}  // namespace crane::configuration
