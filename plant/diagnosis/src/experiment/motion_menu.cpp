#include "experiment/motion_menu.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "crane/plant/coordinates.hpp"
#include "crane/plant/pendulum.hpp"
#include "crane/recording/csv.hpp"

namespace crane::diagnosis {
namespace {

using plant::Axis;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;

/// Share of the reference's speed and acceleration, and of the travel.
constexpr double kShareOfLimits = 0.8;
constexpr double kFirstAction_s = 0.5;
constexpr double kPauseBetween_s = 1.0;

constexpr const char* name_of_axis(Axis axis) { return axis == kTrolley ? "trolley" : "slew"; }

/// Four decimals in the scenario file.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

class Menu {
 public:
  explicit Menu(const configuration::Rig& rig)
      : rig_(rig),
        swing_hz_(plant::swing_radps(rig.plant.gravity_mps2, rig.start.position[kHoist]) /
                  (2 * std::numbers::pi)) {
    for (const Axis axis : {kTrolley, kSlew})
      if (rig.drives[axis].present) axes_.push_back(axis);
  }

  std::vector<SafeMotion> build() {
    for (const Axis axis : axes_) {
      add_slow_sweep(axis);
      add_break_away(axis);
      add_two_speeds(axis);
      add_shaking(axis);
    }
    if (rig_.has_load()) add_swinging_load();
    if (rig_.drives[kHoist].present && !axes_.empty()) add_second_cable_length();
    if (rig_.drives[kSlew].present) add_half_turn();
    if (rig_.has_load() && !axes_.empty()) add_added_mass();
    return std::move(all_);
  }

 private:
  [[nodiscard]] SafeMotion begun(const std::string& name, const std::string& description) const {
    SafeMotion motion;
    motion.name = name;
    motion.description = description;
    motion.load_mass_kg = rig_.plant.load_mass_kg;
    motion.start = rig_.start.position;
    for (const Axis axis : axes_) motion.start[axis] = middle(axis);
    return motion;
  }
  void add(SafeMotion motion) {
    if (!motion.references.empty()) {
      const TimedExcitation& last = motion.references.back();
      motion.duration_s = std::ceil(last.at_s + last.reference.duration_s + kPauseBetween_s);
    }
    all_.push_back(std::move(motion));
  }
  /// Appends a reference after the others.
  void append(SafeMotion& motion, Axis axis, const std::vector<control::Sine>& sines,
              double duration_s) const {
    TimedExcitation next{.at_s = kFirstAction_s,
                         .reference = {.axis = axis, .mean_position = motion.start[axis]}};
    if (!motion.references.empty()) {
      const TimedExcitation& last = motion.references.back();
      next.at_s = last.at_s + last.reference.duration_s + kPauseBetween_s;
    }
    std::copy(sines.begin(), sines.end(), next.reference.sines.begin());
    next.reference.duration_s = duration_s;
    motion.references.push_back(next);
  }

  void add_slow_sweep(Axis axis) {
    constexpr double kFrequency_hz = 0.04;
    SafeMotion motion =
        begun(std::string{"slow_sweep_"} + name_of_axis(axis),
              std::string{"Sweep the "} + name_of_axis(axis) + " slowly over its travel, twice.");
    append(motion, axis, {{amplitude(axis, kFrequency_hz), kFrequency_hz, 0}}, 2 / kFrequency_hz);
    add(std::move(motion));
  }

  void add_break_away(Axis axis) {
    SafeMotion motion = begun(std::string{"break_away_"} + name_of_axis(axis),
                              std::string{"Let the "} + name_of_axis(axis) +
                                  " creep from rest to both sides, again and again, over short distances.");
    constexpr double kFrequency_hz = 0.1, kTravel_s = 0.05;  // distance at reference speed in that time
    const double chosen =
        std::min(kTravel_s * rig_.drives[axis].reference_speed, amplitude(axis, kFrequency_hz));
    append(motion, axis, {{rounded(chosen), kFrequency_hz, 0}}, 40);
    add(std::move(motion));
  }

  void append_two_speeds(SafeMotion& motion, Axis axis) const {
    // The centripetal force acts at twice the frequency of slewing, which must not excite the swing either.
    const double fast_hz = rounded(0.35 * swing_hz_), slow_hz = rounded(fast_hz / 3);
    const double chosen = amplitude(axis, fast_hz);
    append(motion, axis, {{chosen, slow_hz, 0}}, std::round(1.5 / slow_hz));
    append(motion, axis, {{chosen, fast_hz, 0}}, std::round(3 / fast_hz));
  }
  void add_two_speeds(Axis axis) {
    SafeMotion motion = begun(std::string{"two_speeds_"} + name_of_axis(axis),
                              std::string{"Move the "} + name_of_axis(axis) +
                                  " over the same places at two speeds, one three times the other.");
    append_two_speeds(motion, axis);
    add(std::move(motion));
  }

  void add_shaking(Axis axis) {
    const double low_hz = rounded(1.5 * swing_hz_), high_hz = rounded(3.5 * swing_hz_);
    SafeMotion motion =
        begun(std::string{"shaking_"} + name_of_axis(axis),
              std::string{"Shake the "} + name_of_axis(axis) + " at two frequencies, a little.");
    append(motion, axis,
           {{rounded(amplitude(axis, low_hz) / 2), low_hz, 0},
            {rounded(amplitude(axis, high_hz) / 2), high_hz, 0}},
           25);
    add(std::move(motion));
  }

  void add_swinging_load() {
    constexpr double kShareOfLimit = 0.4, kLength_s = 30;
    SafeMotion motion =
        begun("load_swinging", "Pull the load aside, release it and let it swing; the drives are at rest.");
    const double swing = rounded(kShareOfLimit * rig_.limits.swing_limit_rad);
    if (rig_.measures(plant::kSwingRadial)) motion.swing_radial_rad = swing;
    if (rig_.measures(plant::kSwingTangential)) motion.swing_tangential_rad = swing;
    motion.duration_s = kLength_s;
    add(std::move(motion));
  }

  void add_second_cable_length() {
    const configuration::Drive& hoist = rig_.drives[kHoist];
    const double low = hoist.low_limit + hoist.soft_margin, high = hoist.high_limit - hoist.soft_margin;
    const double now = rig_.start.position[kHoist];
    const double other = now - low > high - now ? std::max(low, 0.6 * now) : std::min(high, 1.6 * now);
    SafeMotion motion = begun("second_cable_length", "Move at two speeds with another length of the cable.");
    motion.start[kHoist] = rounded(other);
    for (const Axis axis : axes_) append_two_speeds(motion, axis);
    add(std::move(motion));
  }

  void add_half_turn() {
    constexpr double kFrequency_hz = 0.04, kLeast_rad = 1.2;
    const double turn = std::min(amplitude(kSlew, kFrequency_hz), rounded(std::numbers::pi / 2));
    if (turn < kLeast_rad) return;
    SafeMotion motion = begun("half_turn", "Slew slowly by half a turn and back, twice.");
    append(motion, kSlew, {{turn, kFrequency_hz, 0}}, 2 / kFrequency_hz);
    add(std::move(motion));
  }

  void add_added_mass() {
    constexpr double kAddedShare = 0.5;
    SafeMotion motion = begun("added_mass", "");
    motion.load_mass_kg = rounded((1 + kAddedShare) * rig_.plant.load_mass_kg);
    motion.description = "Add a known " +
                         recording::shortest(rounded(kAddedShare * rig_.plant.load_mass_kg)) +
                         " kg to the load and move at two speeds.";
    for (const Axis axis : axes_) append_two_speeds(motion, axis);
    add(std::move(motion));
  }

  [[nodiscard]] double middle(Axis axis) const {
    return rounded(0.5 * (rig_.drives[axis].low_limit + rig_.drives[axis].high_limit));
  }
  /// Largest amplitude of a sine inside travel, speed and acceleration.
  [[nodiscard]] double amplitude(Axis axis, double frequency_hz) const {
    const configuration::Drive& drive = rig_.drives[axis];
    const double rate = 2 * std::numbers::pi * frequency_hz;
    const double travel = 0.5 * (drive.high_limit - drive.low_limit) - drive.soft_margin;
    const double most =
        std::min({travel, drive.reference_speed / rate, drive.reference_acceleration / (rate * rate)});
    return rounded(kShareOfLimits * most);
  }

  const configuration::Rig& rig_;
  double swing_hz_;  ///< of the load: motions avoid it
  std::vector<Axis> axes_;
  std::vector<SafeMotion> all_;
};

void write_numbers(std::ostream& out, const char* key, const control::Excitation& excitation,
                   double control::Sine::*field) {
  out << key << " = [";
  const char* separator = "";
  for (const control::Sine& sine : excitation.sines) {
    if (sine.amplitude == 0) continue;
    out << separator << recording::shortest(sine.*field);
    separator = ", ";
  }
  out << "]\n";
}

}  // namespace

control::AxisReference SafeMotion::reference(plant::Axis axis, double time_s) const {
  control::AxisReference result{start[axis], 0, 0};
  for (const TimedExcitation& part : references)
    if (part.reference.axis == axis && time_s >= part.at_s) result = part.reference.at(time_s - part.at_s);
  return result;
}

std::vector<SafeMotion> motion_menu(const configuration::Rig& rig) { return Menu{rig}.build(); }

std::string scenario_text(const SafeMotion& motion, const configuration::Rig& rig) {
  using recording::shortest;
  std::ostringstream out;
  out << "# One of the experiments that distinguish causes (docs/diagnosis.md), within the limits of "
      << rig.name << ".\n"
      << "description = \"" << motion.description << "\"\n"
      << "duration_s = " << shortest(motion.duration_s) << "\ncontrollers = [\"none\"]\n";
  if (motion.load_mass_kg != rig.plant.load_mass_kg)
    out << "load_mass_kg = " << shortest(motion.load_mass_kg) << '\n';
  out << "\n[start]\n";
  if (rig.drives[kTrolley].present)
    out << "trolley_position_m = " << shortest(motion.start[kTrolley]) << '\n';
  if (rig.drives[kSlew].present) out << "slew_angle_rad = " << shortest(motion.start[kSlew]) << '\n';
  out << "cable_length_m = " << shortest(motion.start[kHoist]) << '\n';
  if (motion.swing_radial_rad != 0) out << "swing_radial_rad = " << shortest(motion.swing_radial_rad) << '\n';
  if (motion.swing_tangential_rad != 0)
    out << "swing_tangential_rad = " << shortest(motion.swing_tangential_rad) << '\n';
  for (const TimedExcitation& part : motion.references) {
    const bool slew = part.reference.axis == kSlew;
    out << "\n[[excitation]]\nat_s = " << shortest(part.at_s) << "\naxis = \"" << (slew ? "slew" : "trolley")
        << "\"\n"
        << (slew ? "about_rad = " : "about_m = ") << shortest(part.reference.mean_position) << '\n';
    write_numbers(out, slew ? "amplitudes_rad" : "amplitudes_m", part.reference, &control::Sine::amplitude);
    write_numbers(out, "frequencies_hz", part.reference, &control::Sine::frequency_hz);
    out << "duration_s = " << shortest(part.reference.duration_s) << '\n';
  }
  return out.str();
}

}  // namespace crane::diagnosis
