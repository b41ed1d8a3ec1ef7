#include "crane/bring_up/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "crane/bring_up/jog.hpp"
#include "crane/bring_up/swing_fit.hpp"
#include "crane/bring_up/wiring.hpp"

namespace crane::bring_up {
namespace {

constexpr std::array<const char*, kDrives> kOutward{
    "outward, away from the tower", "counter-clockwise, seen from above", "so that the cable became longer"};

std::string with_unit(double value, std::string_view unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.4g %.*s", value, static_cast<int>(unit.size()), unit.data());
  return text;
}

class Calibrating {
 public:
  Calibrating(Session& session, const CalibrationOptions& options)
      : session_{session},
        rig_{session.rig()},
        options_{options},
        frequency_radps_{swing_frequency_radps(rig_)} {
    for (std::size_t i = 0; i < kCounters; ++i) {
      found_.encoder_sign[i] = rig_.encoders[i].sign;
      found_.counts_per_unit[i] = rig_.encoders[i].counts_per_unit;
    }
    for (std::size_t i = 0; i < kDrives; ++i) found_.drive_sign[i] = rig_.drives[i].sign;
    found_.position = rig_.start.position;
  }

  Calibration run() {
    settle();
    for (std::size_t i = 0; i < kDrives; ++i)
      if (rig_.drives[i].present) calibrate_axis(i);
    return found_;
  }

 private:
  std::string ask(const std::string& question) {
    session_.make_safe();
    return options_.ask(question);
  }
  bool yes(const std::string& question) {
    while (true) {
      const auto answer = ask(question + " [y/n]");
      if (answer == "y" || answer == "yes") return true;
      if (answer == "n" || answer == "no") return false;
    }
  }
  /// @return nothing when the answer is empty
  std::optional<double> number(const std::string& question, double low) {
    while (true) {
      const auto answer = ask(question);
      if (answer.empty()) return {};
      try {
        std::size_t end = 0;
        const double value = std::stod(answer, &end);
        if (end == answer.size() && std::isfinite(value) && value > low) return value;
      } catch (const std::logic_error&) {
      }
      options_.say("enter a number in SI units, without the unit");
    }
  }

  [[nodiscard]] bool has_swing(std::size_t counter) const { return rig_.measures(counter); }

  /// One period of the load at rest.
  std::array<SwingFit, kSwingCount> swings() {
    std::array<SwingFit, kSwingCount> fits;
    if (!has_swing(3) && !has_swing(4)) return fits;
    const auto record = session_.record_braked(2 * std::numbers::pi / frequency_radps_);
    for (std::size_t k = 0; k < kSwingCount; ++k) fits[k] = fit_swing(record, kDrives + k, frequency_radps_);
    return fits;
  }

  /// The present angle of the load is the zero of the swing encoders. Therefore the load must hang at rest.
  void settle() {
    while (true) {
      const auto fits = swings();
      const double swing_rad = std::max(fits[0].amplitude_rad(), fits[1].amplitude_rad());
      const double offset_rad = std::max(std::abs(fits[0].offset_rad - rig_.start.swing_radial_rad),
                                         std::abs(fits[1].offset_rad - rig_.start.swing_tangential_rad));
      const bool settled = swing_rad <= kSettled_rad;
      if (settled && offset_rad <= kSettled_rad) return;
      if (settled)
        throw std::runtime_error(
            "the load hangs at rest " + with_unit(offset_rad, "rad") +
            " from the zero of its encoders, because it swung when the board was opened: "
            "start crane hw calibrate again");
      if (!yes("the load swings by " + with_unit(swing_rad, "rad") + " (rest: at most " +
               with_unit(kSettled_rad, "rad") + "); steady the load by hand. Try again?"))
        throw Ended("the load did not come to rest; nothing written");
    }
  }

  void calibrate_axis(std::size_t i) {
    const std::string name{coordinate_name(i)};
    options_.say("testing the brake of " + name);
    require_brake(i);
    options_.say(name + " moves");
    const auto before = swings();
    const auto motion = push(i);
    session_.tick_braked();
    const auto after = swings();
    const bool outward = yes("did the " + name + " move " + kOutward[i] + "?");
    const auto counts = motion.back().counts[i] - motion.front().counts[i];
    if (!outward) found_.drive_sign[i] = -rig_.drives[i].sign;
    found_.encoder_sign[i] = (counts > 0) == outward ? 1 : -1;
    ask_scale(i, counts);
    judge_swing(i, motion, before, after);
    ask_position(i, counts);
  }

  void require_brake(std::size_t i) {
    const double drive_v = std::min({3.0, options_.largest_v, rig_.drives[i].volt_limit_v});
    const auto jog =
        bring_up::run(session_, {.axis = i, .drive_v = drive_v, .distance = kStandstill, .duration_s = 0.1});
    for (std::size_t k = 0; k < kDrives; ++k)
      if (std::abs(jog.moved[k]) > kStandstill)
        throw std::runtime_error("the brake of " + std::string{coordinate_name(i)} + " slipped at " +
                                 with_unit(drive_v, "V") + ": crane hw selftest finds the cause");
  }

  /// Pushes with increasing voltage until the axis has moved half the distance.
  Record push(std::size_t i) {
    Record motion;
    const double largest_v = std::min(options_.largest_v, rig_.drives[i].volt_limit_v);
    for (double drive_v = std::min(1.0, largest_v); drive_v <= largest_v; drive_v += 0.5) {
      JogPlan plan{.axis = i, .drive_v = drive_v, .distance = options_.distance[i], .duration_s = 1.5};
      plan.release[i] = true;
      const auto jog = bring_up::run(session_, plan);
      motion.insert(motion.end(), jog.record.begin(), jog.record.end());
      if (jog.limit)
        throw std::runtime_error(
            std::string{coordinate_name(i)} +
            " has reached a limit switch: move it away from the limit switch and start again");
      if (std::abs(jog.moved[i]) > options_.distance[i] / 2) return motion;
    }
    throw std::runtime_error("the counter of " + std::string{coordinate_name(i)} +
                             " does not follow its drive at " + with_unit(largest_v, "V") +
                             ": crane hw selftest finds the fault");
  }

  void ask_scale(std::size_t i, std::int64_t counts) {
    const auto magnitude = std::abs(static_cast<double>(counts));
    const auto unit = coordinate_unit(i);
    const auto distance = number("how far did it move, in " + std::string{unit} + "? The rig file says " +
                                     with_unit(magnitude / rig_.encoders[i].counts_per_unit, unit) +
                                     "; press Enter if that is right",
                                 0);
    if (distance) found_.counts_per_unit[i] = magnitude / *distance;
  }

  /// Sign of the swing encoder: the load lags behind when the axis moves.
  void judge_swing(std::size_t i, const Record& motion, const std::array<SwingFit, kSwingCount>& before,
                   const std::array<SwingFit, kSwingCount>& after) {
    const auto swing = swing_of(rig_, i);
    if (swing == 0) return;
    // The record has the signs and scales of the rig file.
    const double correction = found_.encoder_sign[i] * rig_.encoders[i].sign *
                              rig_.encoders[i].counts_per_unit / found_.counts_per_unit[i];
    const double lever = (i == plant::kTrolley ? 1 : -found_.position[plant::kTrolley]) * correction;
    const auto expected =
        expected_swing(motion, i, lever, rig_.start.position[plant::kHoist], frequency_radps_);
    const double share = share_of(expected, before[swing - kDrives], after[swing - kDrives]);
    if (std::abs(share) < 0.4)
      throw std::runtime_error("the encoder of " + std::string{coordinate_name(swing)} +
                               " does not show that the load lags behind: crane hw selftest finds the fault");
    if (share < 0) found_.encoder_sign[swing] = -rig_.encoders[swing].sign;
    options_.say(std::string{coordinate_name(swing)} + " shows " + with_unit(std::abs(share), "") +
                 "times the swing that follows from its scale and the cable length");
  }

  void ask_position(std::size_t i, std::int64_t counts) {
    const auto unit = coordinate_unit(i);
    const double here = rig_.start.position[i] +
                        static_cast<double>(counts) * found_.encoder_sign[i] / found_.counts_per_unit[i];
    const auto measured =
        number("where is the " + std::string{coordinate_name(i)} + " now, in " + std::string{unit} +
                   "? Its encoder shows " + with_unit(here, unit) + "; press Enter if that is right",
               -1e3);
    found_.position[i] = measured.value_or(here);
  }

  Session& session_;
  const configuration::Rig& rig_;
  const CalibrationOptions& options_;
  double frequency_radps_;
  Calibration found_;
};

}  // namespace

Calibration calibrate(Session& session, const CalibrationOptions& options) {
  auto found = Calibrating{session, options}.run();
  session.make_safe();
  return found;
}

}  // namespace crane::bring_up
