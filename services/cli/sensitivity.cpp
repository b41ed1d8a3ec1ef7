#include "cli/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include "cli/text_table.hpp"
#include "crane/fields/angle.hpp"
#include "crane/plant/pendulum.hpp"
#include "crane/recording/csv.hpp"

namespace crane::cli {
namespace {

using control::Design;
using experiments::PlannedRun;

using fields::kDegPerRad;

void change_cable(PlannedRun& plan, double ratio) {
  const double length_m = plan.scenario.start[plant::kHoist].value_or(plan.rig.start.position[plant::kHoist]);
  plan.scenario.cable_length_offset_m += (ratio - 1) * length_m;
}

void change_load(PlannedRun& plan, double ratio) {
  plan.scenario.load_mass_kg = ratio * plan.scenario.load_mass_kg.value_or(plan.rig.plant.load_mass_kg);
}

void change_compensation(PlannedRun& plan, double ratio) {
  for (auto& friction : plan.rig.design.friction) friction.factor *= ratio;
}

void delay_commands(PlannedRun& plan, double ticks) {
  for (const auto& [axis, name] : {std::pair{plant::kTrolley, "trolley"}, std::pair{plant::kSlew, "slew"}})
    if (plan.rig.drives[axis].present)
      plan.rig.terms.push_back({"command_delay", name, {{"delay_s", ticks * plan.rig.period_s}}});
}

void filter_rates(PlannedRun& plan, double ratio) { plan.rig.sensing.swing_filter_ratio = ratio; }

void filter_swing(PlannedRun& plan, double ratio) {
  plan.rig.sensing.swing_filter_ratio = ratio;
  plan.rig.sensing.filter_swing_angle = true;
}

double load_period_s(const PlannedRun& plan) {
  return plant::swing_period_s(plan.rig.design.crane.gravity_mps2, plan.rig.design.cable_length_m);
}

/// Reduces the delay of the law by the delay of the filter.
void filter_swing_in_place_of_delay(PlannedRun& plan, double ratio) {
  filter_swing(plan, ratio);
  const double late = filter_delay_s(ratio, plan.rig.period_s) / load_period_s(plan);
  for (double Design::*delay : {&Design::delayed_1_delay, &Design::delayed_2_delay})
    plan.rig.design.*delay = std::max(0.0, plan.rig.design.*delay - late);
}

/// Gains of a controller that a rig file can set; empty when the crane determines every gain.
std::vector<double Design::*> gains_of(std::string_view controller) {
  if (controller == "gain_scheduling_full") return {&Design::full_state_forward_gain_vpm};
  if (controller == "anti_swing_pd")
    return {&Design::anti_swing_proportional, &Design::anti_swing_derivative};
  if (controller == "delayed_1") return {&Design::delayed_1_gain};
  if (controller == "delayed_2") return {&Design::delayed_2_gain};
  if (controller == "fuzzy_printed" || controller == "fuzzy_generated") return {&Design::fuzzy_gain};
  return {};
}

/// Perturbations for the displayed values; the argument of `change` is scale * value + offset.
struct Sweep {
  std::string quantity, unit;
  std::vector<double> values;
  std::function<void(PlannedRun&, double)> change;
};

void append(std::vector<Perturbation>& all, const Sweep& sweep) {
  for (const double value : sweep.values)
    all.push_back({sweep.quantity, sweep.unit, value,
                   [change = sweep.change, value](PlannedRun& plan) { change(plan, value); }});
}

/// Converts a change by a ratio to a change by a displayed value in per cent.
std::function<void(PlannedRun&, double)> percent(void (*change)(PlannedRun&, double)) {
  return [change](PlannedRun& plan, double value) { change(plan, 1 + value / 100); };
}

const experiment::ComparedRun* find(std::span<const PerturbedRun> runs, const PerturbedRun& like,
                                    const std::string& controller) {
  const auto found = std::find_if(runs.begin(), runs.end(), [&](const PerturbedRun& r) {
    return r.quantity == like.quantity && r.value == like.value && r.run.scenario == like.run.scenario &&
           r.run.controller == controller;
  });
  return found == runs.end() ? nullptr : &found->run;
}

std::string name_of(const PerturbedRun& run) {
  if (run.quantity.empty()) return "nominal";
  return run.quantity + ' ' + (run.unit == "%" && run.value > 0 ? "+" : "") + recording::shortest(run.value) +
         (run.unit.empty() ? "" : ' ' + run.unit);
}

std::string cell(const experiment::ComparedRun* run) {
  if (run == nullptr) return "";
  if (!run->stopped_because.empty()) return "stopped: " + run->stopped_because;
  if (!run->metrics) return "-";
  const auto& settling_s = run->metrics->settling_time_s;
  return (settling_s ? fixed(*settling_s, 2) : "-") + " / " +
         fixed(run->metrics->residual_swing_rad * kDegPerRad, 2);
}

template <class Field>
std::vector<std::string> distinct(std::span<const PerturbedRun> runs, Field field) {
  std::vector<std::string> values;
  for (const auto& run : runs)
    if (std::find(values.begin(), values.end(), run.run.*field) == values.end())
      values.push_back(run.run.*field);
  return values;
}

}  // namespace

double filter_delay_s(double cutoff_ratio, double period_s) {
  return std::numbers::sqrt2 / (2 * std::numbers::pi * cutoff_ratio) * period_s;
}

std::vector<Perturbation> perturbations(const PlannedRun& plan) {
  std::vector<Perturbation> all{{"", "", 0, [](PlannedRun&) {}}};
  append(all, {"cable_length", "%", {-50, -25, 25, 50}, percent(change_cable)});
  if (plan.rig.has_load()) append(all, {"load_mass", "%", {-50, -25, 25, 50}, percent(change_load)});
  append(all, {"friction_compensation", "%", {-20, -10, 10, 20}, percent(change_compensation)});
  append(all, {"command_delay", "ticks", {1, 2, 3}, delay_commands});
  append(all, {"rate_filter", "", {0, 0.02, 0.1, 0.2}, filter_rates});
  append(all, {"swing_filter", "", {0.02, 0.05, 0.1, 0.2}, filter_swing});
  if (const auto name = plan.controller->name; name == "delayed_1" || name == "delayed_2")
    append(all, {"swing_filter_for_delay", "", {0.02, 0.05, 0.1, 0.2}, filter_swing_in_place_of_delay});
  if (const auto gains = gains_of(plan.controller->name); !gains.empty())
    append(all, {"gain", "%", {-50, -25, 25, 50}, [gains](PlannedRun& changed, double value) {
                   for (const auto gain : gains) changed.rig.design.*gain *= 1 + value / 100;
                 }});
  return all;
}

void write_sensitivity_csv(std::ostream& out, std::span<const PerturbedRun> runs) {
  out << "scenario,controller,quantity,unit,value,settling_time_s,residual_swing_deg,largest_swing_radial_"
         "deg,"
         "largest_swing_tangential_deg,stopped_because\n";
  for (const auto& [quantity, unit, value, run] : runs) {
    const auto number = [&](auto&& figure) {
      if (run.metrics) out << recording::shortest(figure(*run.metrics));
      out << ',';
    };
    out << run.scenario << ',' << run.controller << ',' << quantity << ',' << unit << ','
        << recording::shortest(value) << ',';
    if (run.metrics && run.metrics->settling_time_s)
      out << recording::shortest(*run.metrics->settling_time_s);
    out << ',';
    number([](const auto& m) { return m.residual_swing_rad * kDegPerRad; });
    number([](const auto& m) { return m.largest_swing_radial_rad * kDegPerRad; });
    number([](const auto& m) { return m.largest_swing_tangential_rad * kDegPerRad; });
    out << run.stopped_because << '\n';
  }
}

void write_sensitivity_markdown(std::ostream& out, std::span<const PerturbedRun> runs) {
  const auto controllers = distinct(runs, &experiment::ComparedRun::controller);
  for (const auto& scenario : distinct(runs, &experiment::ComparedRun::scenario)) {
    out << "## " << scenario << "\n\nSettling time [s] / residual swing [deg]; -: not settled.\n\n|  |";
    for (const auto& controller : controllers) out << ' ' << controller << " |";
    out << "\n|---|" << [&] {
      std::string rule;
      for (std::size_t i = 0; i < controllers.size(); ++i) rule += "--:|";
      return rule;
    }() << '\n';
    std::vector<std::string> listed;
    for (const auto& row : runs) {
      if (row.run.scenario != scenario ||
          std::find(listed.begin(), listed.end(), name_of(row)) != listed.end())
        continue;
      listed.push_back(name_of(row));
      out << "| " << name_of(row) << " |";
      for (const auto& controller : controllers) out << ' ' << cell(find(runs, row, controller)) << " |";
      out << '\n';
    }
    out << '\n';
  }
}

}  // namespace crane::cli
