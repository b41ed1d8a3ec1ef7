#include <cmath>

#include "crane/control/design_fields.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::control {
namespace {

void check_lengths(const Design& design, std::vector<std::string>& found) {
  const double shortest = design.shortest_cable_length_m, longest = design.longest_cable_length_m;
  if (!plant::kCableLengths.contains(shortest))
    found.push_back(fields::complaint("shortest_cable_length_m", shortest, plant::kCableLengths.rule()));
  if (!plant::kCableLengths.contains(longest) || longest < shortest)
    found.push_back(
        fields::complaint("longest_cable_length_m", longest, "must be in [shortest_cable_length_m, 1000]"));
}

void check_friction(const Design& design, std::size_t axis, std::vector<std::string>& found) {
  const DriveFriction& friction = design.friction[axis];
  const std::string prefix = std::string{"friction."} + plant::kCoordinates[axis].name + '.';
  fields::check(friction, kFrictionFields, prefix, found);
  for (const auto& [key, value, rule] : contradictions(friction, design.volt_limit_v[axis]))
    found.push_back(fields::complaint(prefix + std::string{key}, value, rule));
}

}  // namespace

double critical_derivative(const Design& design) { return 2 * std::sqrt(design.tracking_proportional); }

std::vector<std::string> DriveFriction::problems() const {
  std::vector<std::string> found;
  fields::check(*this, kFrictionFields, "", found);
  return found;
}

std::vector<Contradiction> contradictions(const Design& design) {
  constexpr double kLeastDistance = 0.01;
  std::vector<Contradiction> found;
  const double length_m = design.cable_length_m;
  const auto lengths = fields::Range::closed(design.shortest_cable_length_m, design.longest_cable_length_m);
  if (std::isfinite(length_m) && lengths.low <= lengths.high && !lengths.contains(length_m))
    found.push_back({"cable_length_m", length_m, lengths.rule()});
  if (design.fuzzy_gain == 0) found.push_back({"fuzzy_gain", 0, "must not be 0"});
  if (design.fuzzy_point_b < design.fuzzy_point_a + kLeastDistance)
    found.push_back({"fuzzy_point_b", design.fuzzy_point_b, "must be at least fuzzy_point_a + 0.01"});
  return found;
}

std::vector<Contradiction> contradictions(const DriveFriction& friction, double volt_limit_v) {
  std::vector<Contradiction> found;
  for (const auto& [key, held_v] : {std::pair{"stiction_positive_v", friction.stiction_positive_v},
                                    std::pair{"stiction_negative_v", friction.stiction_negative_v},
                                    std::pair{"coulomb_positive_v", friction.coulomb_positive_v},
                                    std::pair{"coulomb_negative_v", friction.coulomb_negative_v}})
    if (held_v > 0 && friction.factor * held_v >= volt_limit_v)
      found.push_back({key, held_v, "the value times factor must be below the volt_limit_v of the drive"});
  return found;
}

std::vector<std::string> problems(const Design& design) {
  std::vector<std::string> found = design.crane.problems();
  if (!plant::kPeriods.contains(design.period_s))
    found.push_back(fields::complaint("period_s", design.period_s, plant::kPeriods.rule()));
  check_lengths(design, found);
  fields::check(design, kDesignFields, "", found);
  fields::check(design.adaptation, kAdaptationFields, "adaptation.", found);
  for (const auto& [key, value, rule] : contradictions(design))
    found.push_back(fields::complaint(std::string{key}, value, rule));
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const double volts = design.volt_limit_v[axis];
    const std::string name = plant::kCoordinates[axis].name;
    if (!kDriveVolts.contains(volts))
      found.push_back(fields::complaint("volt_limit_v." + name, volts, kDriveVolts.rule()));
    check_friction(design, axis, found);
  }
  return found;
}

}  // namespace crane::control
