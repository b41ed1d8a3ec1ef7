#include "crane/bring_up/wiring.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace crane::bring_up {
namespace {

// from this share of the expected swing on, the sign is significant
constexpr double kClearShare = 0.4;

std::string text_of(double value, std::string_view unit) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g %.*s", value, static_cast<int>(unit.size()), unit.data());
  return text;
}

std::string named(std::size_t coordinate) { return std::string{coordinate_name(coordinate)}; }

/// Collects findings about one rig.
class Judgement {
 public:
  Judgement(const configuration::Rig& rig, const Evidence& evidence) : rig_{rig}, evidence_{evidence} {}

  std::vector<Finding> findings() {
    judge_supply();
    for (std::size_t i = 0; i < kDrives; ++i) {
      if (!rig_.drives[i].present) continue;
      judge_brake(i);
      if (evidence_.axis[i].pushed) judge_motion(i);
    }
    drop_explained();
    return std::move(findings_);
  }

 private:
  void add(Fault fault, std::string subject, std::string text) {
    const auto same = [&](const Finding& known) { return known.fault == fault && known.subject == subject; };
    if (std::none_of(findings_.begin(), findings_.end(), same))
      findings_.push_back({fault, std::move(subject), std::move(text)});
  }

  /// Removes the report of a dead swing encoder that is reported as swapped.
  void drop_explained() {
    const auto swapped = [this](const std::string& name) {
      return std::any_of(findings_.begin(), findings_.end(), [&](const Finding& known) {
        return known.fault == Fault::encoders_swapped && known.subject.find(name) != std::string::npos;
      });
    };
    std::erase_if(findings_, [&](const Finding& finding) {
      return finding.fault == Fault::swing_dead && swapped(finding.subject);
    });
  }

  void judge_supply() {
    if (evidence_.estop_pressed)
      add(Fault::estop, "estop",
          "the emergency stop reads pressed: release it, or look for a broken wire at input line " +
              std::to_string(rig_.wiring.estop_input));
    if (evidence_.relay_closed_at_rest)
      add(Fault::relay_stuck, "relay",
          "the watchdog relay is closed although its output does not toggle: the brakes would stay open "
          "when the computer fails; check the relay and its contact (input line " +
              std::to_string(rig_.wiring.relay_closed_input) + ")");
    else if (!evidence_.relay_closed)
      add(Fault::relay_dead, "relay",
          "the watchdog relay does not close while output line " +
              std::to_string(rig_.wiring.watchdog_output) +
              " toggles: check the charge pump and the relay's contact (input line " +
              std::to_string(rig_.wiring.relay_closed_input) + ")");
    else if (!evidence_.relay_dropped)
      add(Fault::relay_stuck, "relay",
          "the watchdog relay does not open within " + text_of(evidence_.relay_limit_s, "s") +
              " after its output has stopped: the brakes would stay open when the computer fails");
  }

  void judge_brake(std::size_t i) {
    const auto& axis = evidence_.axis[i];
    const auto name = named(i);
    const auto output = std::to_string(rig_.wiring.drives[i].brake_release_output);
    if (axis.limit_open)
      add(Fault::limit_open, name,
          "a limit switch of the " + name +
              " axis is open: the axis is at its limit, or a wire is broken (input lines " +
              std::to_string(rig_.wiring.drives[i].limit_low_input) + " and " +
              std::to_string(rig_.wiring.drives[i].limit_high_input) + "); the axis was not moved");
    if (!axis.held)
      add(axis.closed_in_use ? Fault::brake_slips : Fault::brake_stays_open, name,
          "the " + name + " brake" + (axis.closed_in_use ? " does not hold: " : " does not close: ") +
              "it slipped by " + text_of(axis.slipped, coordinate_unit(i)) + " at " +
              text_of(axis.push_v, "V") + " with output line " + output + " off");
    else if (!axis.closed_at_rest || !axis.closed_in_use)
      add(Fault::brake_contact, name,
          "the contact of the " + name + " brake reports open although the brake holds: check input line " +
              std::to_string(rig_.wiring.drives[i].brake_closed_input));
    else
      judge_opening(i);
  }

  void judge_opening(std::size_t i) {
    const auto& axis = evidence_.axis[i];
    const auto name = named(i);
    if (axis.opened && !axis.closed_again)
      add(Fault::brake_slow, name,
          "the " + name + " brake does not close within its brake_close_time_s of " +
              text_of(rig_.drives[i].brake_close_time_s, "s"));
    if (axis.opened) return;
    for (std::size_t k = 0; k < kDrives; ++k) {
      if (!axis.other_opened[k]) continue;
      const auto low = std::min(i, k), high = std::max(i, k);
      return add(Fault::brakes_swapped, named(low) + ", " + named(high),
                 "the brakes of " + named(low) + " and " + named(high) + " are swapped (output lines " +
                     std::to_string(rig_.wiring.drives[low].brake_release_output) + " and " +
                     std::to_string(rig_.wiring.drives[high].brake_release_output) + ", or their contacts)");
    }
    if (evidence_.relay_closed && !axis.limit_open)
      add(Fault::brake_stays_closed, name,
          "the " + name + " brake does not open with output line " +
              std::to_string(rig_.wiring.drives[i].brake_release_output) +
              " on: check its 24 V supply, its coil and its contact (input line " +
              std::to_string(rig_.wiring.drives[i].brake_closed_input) + ")");
  }

  void judge_motion(std::size_t i) {
    const auto& axis = evidence_.axis[i];
    if (std::abs(axis.drift) > kStandstill)
      add(Fault::drift, named(i),
          named(i) + " moves by " + text_of(axis.drift, coordinate_unit(i)) +
              " with its brake open at 0 V: trim the amplifier's offset");
    if (const auto swinging = counter_that_swings(i))
      add_swapped_encoders(*swinging, swing_of(rig_, i));
    else if (std::abs(axis.moved[i]) > kStandstill)
      judge_direction(i);
    else if (const auto other = counter_that_moved(i))
      add_swapped_encoders(i, *other);
    else
      judge_standstill(i);
  }

  /// Judges the signs of drive, encoder and swing encoder of an axis whose counter has changed.
  void judge_direction(std::size_t i) {
    const auto& axis = evidence_.axis[i];
    const bool outward = axis.moved[i] > 0;
    const auto swing = swing_of(rig_, i);
    const bool judged_by_load = swing != 0 && std::abs(axis.expected_rad) > 1.5 * kNoSwing_rad;
    const int load = !judged_by_load ? 0 : axis.share > kClearShare ? 1 : axis.share < -kClearShare ? -1 : 0;
    if (judged_by_load && load == 0) judge_missing_swing(i, swing);
    if (outward && load >= 0) return;
    if (outward) return add_swing_sign(i, swing);
    if (load > 0) return add_drive_sign(i);
    if (load < 0) return add_encoder_sign(i);
    add(Fault::drive_or_encoder_sign, named(i),
        "the counter of the " + named(i) +
            " axis decreases under a positive voltage: the drive or the encoder has the wrong sign. Watch "
            "the axis during `crane hw jog` with a positive voltage. If the axis moves in the negative "
            "direction, change sign in [drive." +
            named(i) + "], otherwise in [encoder." + named(i) + "]");
  }
  void add_swing_sign(std::size_t i, std::size_t swing) {
    add_sign(
        Fault::swing_sign, swing, "encoder",
        "counts in the wrong direction: the load lags behind a motion of the " + named(i) + "; swap A and B");
  }
  void add_drive_sign(std::size_t i) {
    add_sign(Fault::drive_sign, i, "drive",
             "moves the axis in the wrong direction (the encoder is right): swap the motor leads");
  }
  void add_encoder_sign(std::size_t i) {
    add_sign(Fault::encoder_sign, i, "encoder",
             "counts in the wrong direction (the drive is right): swap A and B");
  }
  /// @param part  of the coordinate: drive or encoder
  void add_sign(Fault fault, std::size_t i, const std::string& part, const std::string& what) {
    add(fault, named(i),
        "the " + named(i) + " " + part + " " + what + ", or change sign in [" + part + "." + named(i) + "]");
  }

  void judge_missing_swing(std::size_t i, std::size_t swing) {
    const auto& axis = evidence_.axis[i];
    const std::size_t other = kDrives + kSwingCount - 1 - (swing - kDrives);
    const bool other_swings =
        rig_.measures(other) && axis.swung_rad[other - kDrives] > kClearShare * std::abs(axis.expected_rad);
    if (other_swings) return add_swapped_encoders(swing, other);
    add(Fault::swing_dead, named(swing),
        "the " + named(swing) + " encoder does not show the swing of the load after a motion of the " +
            named(i) + " axis: check its 5 V supply and counter " +
            std::to_string(rig_.encoders[swing].channel));
  }

  /// @return the counter of a drive that shows the swing of the load
  [[nodiscard]] std::optional<std::size_t> counter_that_swings(std::size_t i) const {
    if (swing_of(rig_, i) == 0) return {};
    for (std::size_t k = 0; k < kDrives; ++k)
      if (evidence_.axis[i].counter_swings_rad[k] > kNoSwing_rad) return k;
    return {};
  }

  /// @return the counter of another encoder that follows axis i
  [[nodiscard]] std::optional<std::size_t> counter_that_moved(std::size_t i) const {
    const auto& axis = evidence_.axis[i];
    for (std::size_t k = 0; k < kDrives; ++k)
      if (k != i && std::abs(axis.moved[k]) > kStandstill) return k;
    for (std::size_t k = 0; k < kSwingCount; ++k)  // a load swings back; an axis keeps its new position
      if (std::abs(axis.shifted_rad[k]) > 2 * kNoSwing_rad) return kDrives + k;
    return {};
  }
  void add_swapped_encoders(std::size_t i, std::size_t k) {
    const auto low = std::min(i, k), high = std::max(i, k);
    add(Fault::encoders_swapped, named(low) + ", " + named(high),
        "the " + named(low) + " and " + named(high) + " encoders are swapped (counters " +
            std::to_string(rig_.encoders[low].channel) + " and " +
            std::to_string(rig_.encoders[high].channel) + ")");
  }

  /// Judges an axis whose push has changed no counter.
  void judge_standstill(std::size_t i) {
    const auto& axis = evidence_.axis[i];
    const auto name = named(i);
    for (std::size_t k = 0; k < kDrives; ++k) {
      if (k == i || std::abs(axis.moved_unlocked[k]) <= kStandstill) continue;
      const auto low = std::min(i, k), high = std::max(i, k);
      return add(Fault::drives_swapped, named(low) + ", " + named(high),
                 "the " + named(low) + " and " + named(high) + " drives are swapped (analog outputs " +
                     std::to_string(rig_.drives[low].dac_channel) + " and " +
                     std::to_string(rig_.drives[high].dac_channel) + ")");
    }
    const auto counter = std::to_string(rig_.encoders[i].channel);
    const auto output = std::to_string(rig_.drives[i].dac_channel);
    if (swing_of(rig_, i) != 0 && std::max(axis.swung_rad[0], axis.swung_rad[1]) > kNoSwing_rad)
      return add(Fault::encoder_dead, name,
                 "the " + name + " encoder is dead: the load swings after a push of " +
                     text_of(axis.push_v, "V") + ", but counter " + counter + " does not change");
    if (swing_of(rig_, i) != 0)
      return add(Fault::drive_dead, name,
                 "the " + name + " drive is dead: neither the counter nor the load moves at " +
                     text_of(axis.push_v, "V") + " on analog output " + output +
                     " with its brake open; check amplifier and motor");
    add(Fault::drive_or_encoder_dead, name,
        "the " + name + " drive or encoder is dead: counter " + counter + " does not change at " +
            text_of(axis.push_v, "V") + " on analog output " + output +
            " with its brake open; check whether the axis moves");
  }

  const configuration::Rig& rig_;
  const Evidence& evidence_;
  std::vector<Finding> findings_;
};

}  // namespace

std::string_view name_of(Fault fault) {
  constexpr std::array<std::string_view, 21> kNames{"estop",          "relay_stuck",
                                                    "relay_dead",     "limit_open",
                                                    "brake_contact",  "brake_stays_open",
                                                    "brake_slips",    "brake_stays_closed",
                                                    "brakes_swapped", "brake_slow",
                                                    "drift",          "drive_sign",
                                                    "encoder_sign",   "drive_or_encoder_sign",
                                                    "swing_sign",     "encoders_swapped",
                                                    "drives_swapped", "encoder_dead",
                                                    "drive_dead",     "drive_or_encoder_dead",
                                                    "swing_dead"};
  return kNames.at(static_cast<std::size_t>(fault));
}

std::size_t swing_of(const configuration::Rig& rig, std::size_t axis) {
  const std::size_t swing = axis == plant::kTrolley ? 3 : axis == plant::kSlew ? 4 : 0;
  return swing != 0 && rig.measures(swing) ? swing : 0;
}

std::vector<Finding> judge(const configuration::Rig& rig, const Evidence& evidence) {
  return Judgement{rig, evidence}.findings();
}

}  // namespace crane::bring_up
