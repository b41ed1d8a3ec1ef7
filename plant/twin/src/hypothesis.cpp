#include "crane/twin/hypothesis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "crane/plant/term.hpp"

namespace crane::twin {
namespace {

using configuration::Rig;
using configuration::RigKind;

const std::array kKinds{
    CauseKind{"coulomb_friction",
              "level_v",
              {0.1, 0.2, 0.4},
              true,
              1,
              "V",
              "Coulomb friction of a drive",
              "check bearings, guides and brake of the AXIS, then run crane identify friction"},
    CauseKind{"viscous_friction",
              "vspm",
              {0.1},
              false,
              1,
              "V at the reference speed",
              "viscous friction of a drive",
              "check bearings, guides and brake of the AXIS, then run crane identify friction"},
    CauseKind{"motor_gain",
              "factor",
              {0.05, 0.1},
              true,
              100,
              "%",
              "gain of amplifier, supply or motor of a drive",
              "check amplifier, supply and motor of the AXIS"},
    CauseKind{"position_drift",
              "rate",
              {0.01},
              false,
              100,
              "% of the path",
              "a position encoder slips during motion",
              "check the coupling of the encoder of the AXIS, then home it"},
    CauseKind{kEncoderSlip,
              nullptr,
              {},
              false,
              1,
              "3 counts; more for a drive",
              "an encoder has jumped",
              "stop the crane, check coupling and cable of the encoder, and home the axis"},
    CauseKind{"payload_mass",
              "delta_kg",
              {0.1},
              false,
              100,
              "%",
              "the load mass has changed",
              "weigh the load and correct load_mass_kg in the rig file"},
    CauseKind{"cable_length",
              "delta_m",
              {0.03},
              false,
              100,
              "%",
              "the cable length differs from the measurement of the hoist",
              "measure from the jib to the load's centre and home the hoist"},
    CauseKind{"swing_offset",
              "offset_rad",
              {0.01},
              false,
              1000,
              "mrad",
              "zero error of a swing encoder",
              "let the load hang at rest and zero the swing encoder again"},
    CauseKind{kLoadPushed,
              nullptr,
              {},
              false,
              1,
              "limited by the noise",
              "a person or the wind has pushed the load; not a fault",
              "no action needed: a person or the wind has pushed the load"},
    CauseKind{kUnknown,
              nullptr,
              {},
              false,
              1,
              "",
              "no cause explains half of the residual",
              "record a few minutes of motion and run crane diagnose"}};

std::string about_axis(std::string text, const std::string& axis) {
  constexpr std::string_view kPlaceholder = "AXIS";
  const std::size_t at = text.find(kPlaceholder);
  return at == std::string::npos ? text : text.replace(at, kPlaceholder.size(), axis);
}

/// @param reference  deviation of the parameter from its default
Hypothesis hypothesis(const CauseKind& kind, const std::string& axis, double reference) {
  const plant::TermParameter& parameter =
      *plant::find_parameter(*plant::find_term(kind.name), kind.parameter);
  return {.cause = kind.name,
          .axis = axis,
          .terms = {{kind.name, axis, {{kind.parameter, parameter.default_value + reference}}}},
          .reference = reference,
          .unit = std::string{plant::unit_on(axis, parameter.unit)},
          .remedy = about_axis(kind.remedy, axis)};
}

/// Coulomb friction of the axis in the rig file, minimum of both directions, V.
double dry_friction_v(const Rig& rig, const std::string& axis) {
  double sum = 0;
  for (const plant::TermSetting& term : rig.terms) {
    const auto positive = term.parameters.find("coulomb_positive_v");
    const auto negative = term.parameters.find("coulomb_negative_v");
    if (term.name == "drive_friction" && term.axis == axis && positive != term.parameters.end() &&
        negative != term.parameters.end())
      sum += std::min(positive->second, negative->second);
  }
  return sum;
}

/// Friction can hold a drive, so that its effect is not proportional to its size. Therefore this cause has
/// several hypotheses, with different reference sizes of either sign.
void add_dry_friction(std::vector<Hypothesis>& list, const Rig& rig, const std::string& axis) {
  const CauseKind& kind = cause_kind("coulomb_friction");
  const double least_v = kind.sizes.front(), most_lost_v = 0.6 * dry_friction_v(rig, axis);
  const auto add = [&](double size_v) {
    list.push_back(hypothesis(kind, axis, size_v));
    list.back().only_near = size_v != least_v;
  };
  double lost_v = 0;
  for (const double size_v : kind.sizes) {
    add(size_v);
    const double less_v = std::min(size_v, most_lost_v);
    if (less_v >= least_v && less_v > lost_v) add(-less_v);
    lost_v = less_v;
  }
}

/// The effect of the gain is not proportional to its size either: friction holds a weaker drive longer.
void add_gain(std::vector<Hypothesis>& list, const std::string& axis) {
  const CauseKind& kind = cause_kind("motor_gain");
  for (const double sign : {1.0, -1.0})
    for (const double size : kind.sizes) {
      list.push_back(hypothesis(kind, axis, sign * size));
      list.back().only_near = sign * size != kind.sizes.front();
    }
}

void add_drive(std::vector<Hypothesis>& list, const Rig& rig, plant::Axis drive, stepper::Output encoder) {
  const std::string axis = plant::kCoordinates[drive].axis;
  add_dry_friction(list, rig, axis);
  const CauseKind& viscous = cause_kind("viscous_friction");
  list.push_back(
      hypothesis(viscous, axis, viscous.sizes.front() / std::max(rig.drives[drive].reference_speed, 1e-3)));
  add_gain(list, axis);
  // A slip changes the measured value only: it is added to the prediction, not to the model.
  const CauseKind& slipping = cause_kind("position_drift");
  list.push_back(hypothesis(slipping, axis, slipping.sizes.front()));
  list.back().terms.clear();
  list.back().slip[encoder] = slipping.sizes.front();
}

void add_load(std::vector<Hypothesis>& list, const char* cause, const std::string& axis, double per_size) {
  const CauseKind& kind = cause_kind(cause);
  list.push_back(hypothesis(kind, axis, kind.sizes.front() * per_size));
}

/// "±0.1, ±0.2 and ±0.4 V"
std::string sizes_text(const CauseKind& kind) {
  std::string text;
  for (std::size_t i = 0; i < kind.sizes.size(); ++i) {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), "%g", kind.shown_per_size * kind.sizes[i]);
    text += i == 0 ? "" : i + 1 < kind.sizes.size() ? ", " : " and ";
    text += (kind.either_sign ? "±" : "") + std::string{number.data()};
  }
  return text + (text.empty() ? "" : " ") + kind.sizes_text;
}

}  // namespace

std::span<const CauseKind> cause_kinds() { return kKinds; }

const CauseKind& cause_kind(std::string_view name) {
  return *std::ranges::find(kKinds, name, [](const CauseKind& kind) { return std::string_view{kind.name}; });
}

std::string cause_table() {
  std::string table = "| cause | reference size | meaning |\n|---|---|---|\n";
  for (const CauseKind& kind : kKinds)
    table += std::string{"| `"} + kind.name + "` | " + sizes_text(kind) + " | " + kind.meaning + " |\n";
  return table;
}

std::vector<Hypothesis> hypotheses_for(const Rig& rig) {
  std::vector<Hypothesis> list;
  const bool trolley = rig.drives[plant::kTrolley].present, slew = rig.drives[plant::kSlew].present;
  if (trolley) add_drive(list, rig, plant::kTrolley, stepper::kTrolleyPosition);
  if (slew) add_drive(list, rig, plant::kSlew, stepper::kSlewAngle);
  if (!rig.has_load()) return list;
  if (trolley || slew) add_load(list, "payload_mass", "", rig.plant.load_mass_kg);
  add_load(list, "cable_length", "", rig.start.position[plant::kHoist]);
  add_load(list, "swing_offset", stepper::axis_of(stepper::kRadialSwing), 1);
  if (rig.kind == RigKind::tower)
    add_load(list, "swing_offset", stepper::axis_of(stepper::kTangentialSwing), 1);
  return list;
}

}  // namespace crane::twin
