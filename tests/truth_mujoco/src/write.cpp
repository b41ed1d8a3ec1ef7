#include "write.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

namespace mujoco_truth {
namespace {

using Json = nlohmann::ordered_json;

/// A column as another laboratory writes it: canonical = factor * sign * column.
struct Foreign {
  const char *canonical, *name;
  double factor, sign;
};
constexpr std::array kForeign{Foreign{"time_s", "t_ms", 1e-3, 1},
                              Foreign{"trolley_voltage_v", "u_trolley", 1, -1},
                              Foreign{"slew_voltage_v", "u_slew", 1, 1},
                              Foreign{"trolley_position_m", "x_mm", 1e-3, -1},
                              Foreign{"slew_angle_rad", "slew_deg", std::numbers::pi / 180, 1},
                              Foreign{"swing_radial_rad", "alpha_deg", std::numbers::pi / 180, -1},
                              Foreign{"swing_tangential_rad", "beta_deg", std::numbers::pi / 180, 1},
                              Foreign{"cable_length_m", "rope_m", 1, 1}};

const Foreign& foreign(const std::string& canonical) {
  for (const Foreign& f : kForeign)
    if (canonical == f.canonical) return f;
  throw std::logic_error(canonical);
}

std::vector<std::string> columns_of(const Rig& rig) {
  std::vector<std::string> names{"time_s"};
  if (rig.drive[kTrolley].there) names.emplace_back("trolley_voltage_v");
  if (rig.drive[kSlew].there) names.emplace_back("slew_voltage_v");
  if (rig.drive[kTrolley].there) names.emplace_back("trolley_position_m");
  if (rig.drive[kSlew].there) names.emplace_back("slew_angle_rad");
  if (rig.has_swing(kRadial)) names.emplace_back("swing_radial_rad");
  if (rig.has_swing(kTangential)) names.emplace_back("swing_tangential_rad");
  if (rig.hoist) names.emplace_back("cable_length_m");
  return names;
}

double value_of(const std::string& column, const Row& row, const RunPlan& plan) {
  if (column == "time_s") return row.time_s;
  if (column == "trolley_voltage_v") return row.command_v[kTrolley];
  if (column == "slew_voltage_v") return row.command_v[kSlew];
  if (column == "trolley_position_m") return row.position[kTrolley];
  if (column == "slew_angle_rad") return row.position[kSlew];
  if (column == "swing_radial_rad") return row.swing[kRadial];
  if (column == "swing_tangential_rad") return row.swing[kTangential];
  return plan.cable_m;
}

void write_csv(const Run& run, const Set& set, const std::filesystem::path& file) {
  std::ofstream out(file);
  const auto names = columns_of(set.rig);
  for (std::size_t i = 0; i < names.size(); ++i)
    out << (i > 0 ? "," : "") << (set.nuisance.foreign_columns ? foreign(names[i]).name : names[i].c_str());
  out << '\n';
  char text[40];
  for (const Row& row : run.rows) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      double value = value_of(names[i], row, run.plan);
      if (set.nuisance.foreign_columns) value = foreign(names[i]).sign * value / foreign(names[i]).factor;
      std::snprintf(text, sizeof text, "%s%.12g", i > 0 ? "," : "", value);
      out << text;
    }
    out << '\n';
  }
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

void write_mapping(const Set& set, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "[columns]\n";
  for (const std::string& name : columns_of(set.rig)) {
    const Foreign& f = foreign(name);
    out << name << " = { column = \"" << f.name << "\", factor = " << f.factor << (f.factor == 1 ? ".0" : "")
        << ", sign = " << f.sign << " }\n";
  }
}

Json json_of(const Nuisance& n) {
  return {{"disturbance_n", n.disturbance_n},
          {"drive_disturbance_v", n.drive_disturbance_v},
          {"correlation_s", n.correlation_s},
          {"swing_wanted_deg", n.swing_rad * 180 / std::numbers::pi},
          {"rate_hz", n.rate_hz},
          {"jitter", n.jitter},
          {"dropped", n.dropped},
          {"swing_resolution", n.swing_resolution},
          {"position_resolution", n.position_resolution},
          {"noise_counts", n.noise_counts},
          {"standstill_law", name_of(n.law)},
          {"presliding_m", n.presliding_m},
          {"controller", name_of(n.controller)},
          {"bandwidth_radps", n.bandwidth_radps},
          {"anti_swing", n.anti_swing},
          {"geometry", n.geometry},
          {"foreign_columns", n.foreign_columns},
          {"states_resolution", n.states_resolution}};
}

Json json_of(const Scored& scored) {
  const Fault& fault = scored.fault;
  Json columns = Json::object();
  for (const Column& c : scored.columns)
    columns[c.name] = {{"effect_rms", c.effect}, {"nuisance_rms", c.nuisance}};
  return {{"name", fault.name},
          {"axis", fault.axis},
          {"in_library", fault.in_library},
          {"parameters", fault.parameters()},
          {"wanted_size", scored.wanted},
          {"size", scored.size},
          {"columns", columns}};
}

Json json_of(const std::vector<Run>& runs) {
  Json all = Json::array();
  for (const Run& run : runs)
    all.push_back({{"experiment", name_of(run.plan.experiment)},
                   {"duration_s", run.plan.duration_s},
                   {"cable_m", run.plan.cable_m},
                   {"amplitude", run.plan.amplitude},
                   {"rows", run.rows.size()}});
  return all;
}

}  // namespace

void write(const Set& set, const std::filesystem::path& directory, const std::filesystem::path& truth) {
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "rig.toml") << rig_toml(set);
  for (std::size_t i = 0; i < set.train.size(); ++i)
    write_csv(set.train[i], set, directory / ("train_" + std::to_string(i + 1) + ".csv"));
  for (std::size_t i = 0; i < set.test.size(); ++i)
    write_csv(set.test[i], set, directory / ("test_" + std::to_string(i + 1) + ".csv"));
  if (set.nuisance.foreign_columns) write_mapping(set, directory / "mapping.toml");
  Json faults = Json::array();
  for (const Scored& scored : set.faults) faults.push_back(json_of(scored));
  const Json json{{"number", set.number},
                  {"kind", name_of(set.kind)},
                  {"rig_kind", name_of(set.rig.kind)},
                  {"effects", faults},
                  {"alike", set.alike},
                  {"swing_deg", set.swing_reached_rad * 180 / std::numbers::pi},
                  {"nuisance", json_of(set.nuisance)},
                  {"train", json_of(set.train)},
                  {"test", json_of(set.test)}};
  std::filesystem::create_directories(truth.parent_path());
  std::ofstream(truth) << json.dump(1) << '\n';
}

}  // namespace mujoco_truth
