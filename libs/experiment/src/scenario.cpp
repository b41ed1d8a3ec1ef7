#include "crane/experiment/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/configuration/extended_file.hpp"
#include "crane/control/cable_tolerance.hpp"
#include "crane/experiment/variant.hpp"
#include "crane/fields/angle.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/plant/parameter_fields.hpp"
#include "crane/recording/csv.hpp"

namespace crane::experiment {
namespace {

using configuration::Range;
using configuration::Rig;
using configuration::TomlTable;
using recording::shortest;

using fields::kRadPerDeg;
constexpr Range kLoads = fields::field_of(plant::kParameterFields, "load_mass_kg").range;
constexpr Range kTimes = Range::closed(0, 86'400);
using plant::kPositions;

/// An angle or rate with two keys, in rad or in degrees; only one of them may be given.
struct AngleKey {
  const char* rad;
  const char* deg;
};

std::optional<double> angle(TomlTable& table, const AngleKey& key, const Range& range) {
  const bool in_rad = table.has(key.rad);
  const bool in_deg = table.has(key.deg);
  if (in_rad && in_deg)
    table.problem(key.deg, std::string{"give either this key or "} + key.rad + ", not both");
  if (in_rad) return table.number(key.rad, range);
  if (in_deg)
    return table.number(key.deg, Range::closed(range.low / kRadPerDeg, range.high / kRadPerDeg)) * kRadPerDeg;
  return std::nullopt;
}

std::optional<double> length(TomlTable& table, const char* key, const Range& range) {
  if (!table.has(key)) return std::nullopt;
  return table.number(key, range);
}

/// Reads the position of each axis and checks it against the travel of a rig.
class PositionReader {
 public:
  /// @param inside_margin  true for targets: the soft margin applies; false for start positions
  PositionReader(const Rig* rig, bool inside_margin) : rig_{rig}, inside_margin_{inside_margin} {}

  std::array<std::optional<double>, plant::kAxes> read(TomlTable& table) const {
    std::array<std::optional<double>, plant::kAxes> positions;
    positions[plant::kTrolley] = length(table, "trolley_position_m", kPositions);
    positions[plant::kSlew] = angle(table, {"slew_angle_rad", "slew_angle_deg"}, kPositions);
    positions[plant::kHoist] = length(table, "cable_length_m", kPositions);
    const char* slew_key = table.has("slew_angle_deg") ? "slew_angle_deg" : "slew_angle_rad";
    const std::array<const char*, plant::kAxes> keys{"trolley_position_m", slew_key, "cable_length_m"};
    for (std::size_t axis = 0; axis < plant::kAxes; ++axis)
      if (rig_ != nullptr && positions[axis]) check(table, keys[axis], axis, *positions[axis]);
    return positions;
  }

 private:
  void check(TomlTable& table, const std::string& key, std::size_t axis, double position) const {
    const configuration::Drive& drive = rig_->drives[axis];
    if (!drive.present) {
      // A start position is permitted for an axis without a drive: a pendulum has a cable but no hoist.
      if (inside_margin_)
        table.problem(key, rig_->name + " has no " + plant::kCoordinates[axis].name + " drive");
      return;
    }
    const double margin = inside_margin_ ? drive.soft_margin : 0;
    const double low = drive.low_limit + margin;
    const double high = drive.high_limit - margin;
    // The tolerance permits a target at the limit in spite of the rounding of degrees to radians.
    constexpr double kRounding = 1e-9;
    if (!(position < low - kRounding || position > high + kRounding)) return;
    const double scale = key.ends_with("_deg") ? 1 / kRadPerDeg : 1;
    const auto rounded = [scale](double value) { return shortest(std::round(value * scale * 1e6) / 1e6); };
    table.problem(key, "must be in [" + rounded(low) + ", " + rounded(high) + "], the travel of " +
                           rig_->name + (inside_margin_ ? " minus the soft margin" : ""));
  }

  const Rig* rig_;
  bool inside_margin_;
};

void read_start(TomlTable& root, const Rig* rig, Scenario& scenario) {
  TomlTable start = root.table("start");
  scenario.start = PositionReader{rig, false}.read(start);
  if (scenario.start[plant::kHoist] && !plant::kCableLengths.contains(*scenario.start[plant::kHoist]))
    start.problem("cable_length_m", plant::kCableLengths.rule());
  scenario.swing_radial_rad =
      angle(start, {"swing_radial_rad", "swing_radial_deg"}, plant::kSwingAngles).value_or(0);
  scenario.swing_tangential_rad =
      angle(start, {"swing_tangential_rad", "swing_tangential_deg"}, plant::kSwingAngles).value_or(0);
}

void read_moves(TomlTable& root, const Rig* rig, Scenario& scenario) {
  for (TomlTable& table : root.tables("move")) {
    Move move;
    move.at_s = table.number("at_s", kTimes);
    move.target = PositionReader{rig, true}.read(table);
    if (!(move.target[0] || move.target[1] || move.target[2]))
      table.problem("at_s",
                    "the move has no target: give trolley_position_m, slew_angle_deg or cable_length_m");
    if (!scenario.moves.empty() && move.at_s <= scenario.moves.back().at_s)
      table.problem("at_s", "must be later than the previous move");
    scenario.moves.push_back(move);
  }
}

std::array<control::Sine, 4> read_sines(TomlTable& table, const std::string& amplitudes_key) {
  constexpr Range kFrequencies = Range::closed(0, 1000);
  const auto amplitudes = table.numbers(amplitudes_key, kPositions);
  const auto frequencies_hz = table.numbers("frequencies_hz", kFrequencies);
  auto phases_rad = table.numbers("phases_rad", kPositions);
  if (phases_rad.empty()) phases_rad.resize(amplitudes.size());
  std::array<control::Sine, 4> sines{};
  if (amplitudes.size() > sines.size())
    table.problem(amplitudes_key, "must be at most " + std::to_string(sines.size()) + " sines");
  else if (frequencies_hz.size() != amplitudes.size() || phases_rad.size() != amplitudes.size())
    table.problem(amplitudes_key, "must have as many values as frequencies_hz, and as phases_rad when given");
  else
    for (std::size_t i = 0; i < amplitudes.size(); ++i)
      sines[i] = {amplitudes[i], frequencies_hz[i], phases_rad[i]};
  return sines;
}

void check_excursion(TomlTable& table, const std::string& key, const Rig& rig,
                     const control::Excitation& reference) {
  constexpr double kRounding = 1e-9;
  const configuration::Drive& drive = rig.drives[reference.axis];
  if (!drive.present) return table.problem("axis", rig.name + " has no such drive");
  double excursion = 0;
  for (const control::Sine& sine : reference.sines) excursion += std::abs(sine.amplitude);
  const double low = drive.low_limit + drive.soft_margin, high = drive.high_limit - drive.soft_margin;
  if (reference.mean_position - excursion < low - kRounding ||
      reference.mean_position + excursion > high + kRounding)
    table.problem(key, "with its sines must stay in [" + shortest(low) + ", " + shortest(high) +
                           "], the travel of " + rig.name + " minus the soft margin");
}

void read_excitations(TomlTable& root, const Rig* rig, Scenario& scenario) {
  constexpr Range kDurations = Range::closed(0, 3600);
  for (TomlTable& table : root.tables("excitation")) {
    Excitation excitation;
    excitation.at_s = table.number("at_s", kTimes);
    const std::string axis = table.choice("axis", plant::drive_names());
    control::Excitation& reference = excitation.reference;
    while (reference.axis + 1 < plant::kAxes && axis != plant::kCoordinates[reference.axis].name)
      ++reference.axis;
    const std::string about_key = std::string{"about_"} + plant::kCoordinates[reference.axis].unit;
    reference.mean_position = table.number(about_key, kPositions);
    reference.sines =
        read_sines(table, std::string{"amplitudes_"} + plant::kCoordinates[reference.axis].unit);
    reference.duration_s = table.number("duration_s", kDurations, 0);
    if (rig != nullptr) check_excursion(table, about_key, *rig, reference);
    if (!scenario.excitations.empty() && excitation.at_s <= scenario.excitations.back().at_s)
      table.problem("at_s", "must be later than the previous excitation");
    scenario.excitations.push_back(excitation);
  }
}

void read_kicks(TomlTable& root, Scenario& scenario) {
  constexpr Range kRates = Range::closed(-20, 20);
  for (TomlTable& table : root.tables("kick")) {
    Kick kick;
    kick.at_s = table.number("at_s", kTimes);
    kick.radial_radps = angle(table, {"radial_radps", "radial_degps"}, kRates).value_or(0);
    kick.tangential_radps = angle(table, {"tangential_radps", "tangential_degps"}, kRates).value_or(0);
    if (kick.radial_radps == 0 && kick.tangential_radps == 0)
      table.problem("at_s", "the kick has no rate: give radial_degps or tangential_degps");
    if (!scenario.kicks.empty() && kick.at_s <= scenario.kicks.back().at_s)
      table.problem("at_s", "must be later than the previous kick");
    scenario.kicks.push_back(kick);
  }
}

void read_defaults(TomlTable& root, Scenario& scenario) {
  scenario.rig = root.text("rig", "");
  scenario.controllers = root.texts("controllers");
  for (const auto& name : scenario.controllers)
    if (control::find_controller(name) == nullptr)
      root.problem("controllers", "no controller has the name " + name);
  scenario.variants = root.texts("variants");
  for (const auto& names : scenario.variants)
    for (const auto& problem : variant_problems(names)) root.problem("variants", problem);
}

}  // namespace

double Scenario::first_action_s() const {
  double first_s = std::numeric_limits<double>::infinity();
  if (!moves.empty()) first_s = std::min(first_s, moves.front().at_s);
  if (!excitations.empty()) first_s = std::min(first_s, excitations.front().at_s);
  if (!kicks.empty()) first_s = std::min(first_s, kicks.front().at_s);
  return std::isfinite(first_s) ? first_s : 0;
}

double Scenario::last_action_s() const {
  double last_s = 0;
  if (!moves.empty()) last_s = std::max(last_s, moves.back().at_s);
  if (!excitations.empty()) last_s = std::max(last_s, excitations.back().at_s);
  if (!kicks.empty()) last_s = std::max(last_s, kicks.back().at_s);
  return last_s;
}

Scenario parse_scenario(const std::string& text, const std::string& file, const Rig* rig) {
  TomlTable root = configuration::with_base(text, file);
  Scenario scenario;
  scenario.name = std::filesystem::path{file}.stem().string();
  scenario.path = file;
  scenario.description = root.text("description");
  scenario.duration_s = root.number("duration_s", Range::above(0, kTimes.high), scenario.duration_s);
  if (root.has("load_mass_kg")) scenario.load_mass_kg = root.number("load_mass_kg", kLoads);
  scenario.cable_length_offset_m =
      root.number("cable_length_offset_m", kPositions, scenario.cable_length_offset_m);
  if (root.has("least_settling_time_s"))
    scenario.least_settling_time_s = root.number("least_settling_time_s", Range::above(0, kTimes.high));
  read_defaults(root, scenario);
  read_start(root, rig, scenario);
  read_moves(root, rig, scenario);
  read_excitations(root, rig, scenario);
  read_kicks(root, scenario);
  if (scenario.last_action_s() >= scenario.end_s())
    root.problem("duration_s", "the run ends before its last move, excitation or kick, at " +
                                   shortest(scenario.last_action_s()) + " s");
  root.finish();
  return scenario;
}

Scenario load_scenario(const std::filesystem::path& file, const Rig* rig) {
  return parse_scenario(configuration::file_text(file), file.string(), rig);
}

Rig with_start_of(Rig rig, const Scenario& scenario) {
  for (std::size_t axis = 0; axis < plant::kAxes; ++axis)
    rig.start.position[axis] = scenario.start[axis].value_or(rig.start.position[axis]);
  rig.start.swing_radial_rad = scenario.swing_radial_rad;
  rig.start.swing_tangential_rad = scenario.swing_tangential_rad;
  rig.start.cable_length_offset_m += scenario.cable_length_offset_m;
  // The check of the swing encoders would stop a crane with a larger error of the cable length: switches the
  // model checks off.
  if (std::abs(scenario.cable_length_offset_m) > control::kCableTolerance * rig.start.position[plant::kHoist])
    rig.limits.model_checks = false;
  rig.plant.load_mass_kg = scenario.load_mass_kg.value_or(rig.plant.load_mass_kg);
  return rig;
}

}  // namespace crane::experiment
