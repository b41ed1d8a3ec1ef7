#include "tuning/candidates.hpp"

#include <cmath>
#include <stdexcept>

#include "crane/configuration/rig_fields.hpp"
#include "crane/recording/csv.hpp"

namespace crane::tuning {
namespace {

template <class Section, std::size_t N>
bool set_in(const std::array<fields::Field<Section>, N>& table, Section& section, const std::string& key,
            double value) {
  for (const auto& field : table)
    if (field.key == key)
      if (auto* number = const_cast<double*>(fields::number_of(field, section))) {  // of a mutable section
        *number = value;
        return true;
      }
  return false;
}

class List {
 public:
  void add(const std::string& controller, std::vector<std::pair<std::string, double>> gains = {},
           bool observer = false) {
    candidates.push_back({controller, std::move(gains), observer});
  }
  /// Adds one candidate for every pair of values.
  void grid(const std::string& controller, const std::string& first, const std::vector<double>& firsts,
            const std::string& second, const std::vector<double>& seconds) {
    for (const double a : firsts)
      for (const double b : seconds) add(controller, {{first, a}, {second, b}});
  }
  std::vector<Candidate> candidates;
};

}  // namespace

std::string Candidate::label() const {
  std::string text = controller;
  for (const auto& [key, value] : gains) text += ", " + key + " = " + recording::shortest(value);
  return observer ? text + ", swing_observer" : text;
}

configuration::Rig with_candidate(configuration::Rig rig, const Candidate& candidate) {
  rig.controller = candidate.controller;
  rig.design.swing_observer = candidate.observer;
  for (const auto& [key, value] : candidate.gains) {
    std::string name = key;
    if (!set_in(control::kDesignFields, rig.design, name, value) &&
        !set_in(configuration::kPlanningFields, rig.planning, name, value))
      throw std::logic_error("no key " + key + " of [controller]");
    if (key == "tracking_proportional")
      rig.design.tracking_derivative =
          2 * std::sqrt(value);  // (3.42) of H. M. Omar, Control of Gantry and Tower Cranes
  }
  return rig;
}

std::vector<Candidate> candidates() {
  List list;
  for (const bool observer : {false, true}) {
    list.add("gain_scheduling_partial", {}, observer);
    for (const double gain : {1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
      list.add("gain_scheduling_full", {{"full_state_forward_gain_vpm", gain}}, observer);
    list.add("lqr", {}, observer);
  }
  list.grid("anti_swing_pd", "anti_swing_proportional", {-20, -30, -40}, "anti_swing_derivative", {5, 8, 11});
  list.grid("delayed_1", "delayed_1_gain", {-50, -70, -90}, "delayed_1_delay", {0.07, 0.1, 0.13});
  list.grid("delayed_2", "delayed_2_gain", {-0.2, -0.33, -0.45}, "delayed_2_delay", {0.18, 0.25, 0.31});
  for (const double gain : {-60.0, -90.0}) list.add("fuzzy_printed", {{"fuzzy_gain", gain}});
  list.add("fuzzy_generated");
  list.add("anti_swing_pd_optimised");
  list.add("delayed_1_optimised");
  list.add("delayed_2_optimised");
  for (const char* shaped : {"none", "shaped_zv", "shaped_zvd", "shaped_ei"})
    for (const double gain : {64.0, 100.0, 200.0}) list.add(shaped, {{"tracking_proportional", gain}});
  list.grid("time_optimal", "planned_swing_rad", {0.0873, 0.1745, 0.2618}, "planned_volt_share", {0.8, 0.95});
  return std::move(list.candidates);
}

}  // namespace crane::tuning
