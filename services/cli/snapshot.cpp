#include "cli/snapshot.hpp"

#include <algorithm>
#include <array>
#include <ostream>
#include <ranges>

#include "cli/sample_json.hpp"
#include "cli/text_table.hpp"
#include "cli/tool_bus.hpp"
#include "crane/bridge/last_line.hpp"
#include "crane/bus/newest.hpp"
#include "crane/fields/angle.hpp"
#include "crane/supervisor/modes.hpp"
#include "crane/supervisor/states.hpp"
#include "observation/traffic.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

using fields::kDegPerRad;

void print_nodes(std::ostream& out, const Snapshot& snapshot) {
  TextTable table{{"process", "vendor", "pid", "phase", "controller", "ticks", "lost", "late", "duplicate",
                   "rejected", "step mean us", "max us"}};
  for (const auto& [number, node] : snapshot.nodes)
    table.add({node.name, node.vendor, std::to_string(node.pid), observation::phase_name(node.phase),
               node.controller, std::to_string(node.ticks), std::to_string(node.lost_ticks),
               std::to_string(node.late_samples), std::to_string(node.duplicate_samples),
               std::to_string(node.rejected_samples), fixed(node.step_mean_us, 1),
               fixed(node.step_max_us, 1)});
  table.print(out);
}

void print_axes(std::ostream& out, const msg::State& state) {
  const auto brake = [&](std::size_t axis) {
    return std::string{state.brake_closed[axis] ? "closed" : "open"} +
           (state.position_known[axis] ? "" : ", not homed");
  };
  TextTable table{{"axis", "position", "", "speed", "", "volts", "brake"}};
  table.add({"trolley", fixed(state.trolley_position_m, 4), "m", fixed(state.trolley_speed_mps, 4), "m/s",
             fixed(state.applied_v[0], 3), brake(0)});
  table.add({"slew", fixed(state.slew_angle_rad * kDegPerRad, 2), "deg",
             fixed(state.slew_speed_radps * kDegPerRad, 2), "deg/s", fixed(state.applied_v[1], 3), brake(1)});
  table.add({"hoist", fixed(state.cable_length_m, 4), "m", fixed(state.cable_speed_mps, 4), "m/s",
             fixed(state.applied_v[2], 3), brake(2)});
  table.print(out);
  out << "swing  radial " << fixed(state.swing_radial_rad * kDegPerRad, 2) << " deg, tangential "
      << fixed(state.swing_tangential_rad * kDegPerRad, 2) << " deg  (tick " << state.header.tick << ")\n";
}

void print_twin(std::ostream& out, const msg::Twin& twin) {
  constexpr std::array kStates{"waits for consecutive ticks", "learns the scatter of the residual",
                               "agrees: the residual is within its band", "deviates"};
  out << "twin  " << kStates.at(static_cast<std::size_t>(twin.state));
  if (twin.state == crane_TWIN_LEARNING)
    out << ", " << fixed(100 * twin.learnt_share, 0) << " % of the motion";
  if (twin.cause[0] != '\0') {
    out << ": likely " << twin.cause;
    if (twin.axis[0] != '\0') out << " (" << twin.axis << ")";
    if (twin.unit[0] != '\0') out << ' ' << fixed(twin.size, 4) << ' ' << twin.unit;
  }
  out << '\n';
}

/// "0.90 +- 0.01"
std::string with_deviation(double value, double deviation, int digits) {
  return fixed(value, digits) + " +- " + fixed(deviation, digits);
}

const char* freeze_text(crane_AdaptationFreeze reason) {
  constexpr std::array kTexts{"learns",
                              "oscillated at standstill",
                              "rolled back",
                              "waits for consecutive ticks",
                              "brake closed",
                              "demand not executed",
                              "at the voltage limit",
                              "load swings too far",
                              "cable moves",
                              "at rest",
                              "implausible"};
  const auto number = static_cast<std::size_t>(reason);
  return number < kTexts.size() ? kTexts[number] : "unknown";
}

void print_adaptation(std::ostream& out, const msg::Adaptation& adaptation) {
  TextTable table{{"adaptation", "direction", "coulomb V", "viscous V", "static V", "used V", "confidence",
                   "now", "roll-backs"}};
  constexpr std::array kAxes{"trolley", "slew"};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    const auto& axis = adaptation.axis[i];
    if (axis.phase == crane_ADAPTATION_OFF) continue;
    for (const auto* direction : {&axis.positive, &axis.negative})
      table.add({kAxes.at(i), direction == &axis.positive ? "positive" : "negative",
                 with_deviation(direction->coulomb_v, direction->coulomb_std_v, 3),
                 with_deviation(direction->viscous_v, direction->viscous_std_v, 3),
                 with_deviation(direction->static_v, direction->static_std_v, 3),
                 fixed(direction->used_coulomb_v, 3), fixed(100 * axis.confidence, 0) + " %",
                 freeze_text(axis.freeze), std::to_string(axis.roll_backs)});
  }
  table.print(out);
  out << "payload " << with_deviation(adaptation.load_mass_kg, adaptation.load_mass_std_kg, 2)
      << " kg, pendulum " << with_deviation(adaptation.pendulum_length_m, adaptation.pendulum_length_std_m, 3)
      << " m, swing offset radial "
      << with_deviation(adaptation.swing_offset_rad[0] * kDegPerRad,
                        adaptation.swing_offset_std_rad[0] * kDegPerRad, 2)
      << " deg, tangential "
      << with_deviation(adaptation.swing_offset_rad[1] * kDegPerRad,
                        adaptation.swing_offset_std_rad[1] * kDegPerRad, 2)
      << " deg  (" << adaptation.moves << " moves)\n";
}

}  // namespace

const char* remedy(const msg::SupervisorStatus& status) {
  return status.cause == crane_CAUSE_NONE
             ? ""
             : supervisor::remedy_for(static_cast<supervisor::Cause>(status.cause));
}

void print_supervisor(std::ostream& out, const msg::SupervisorStatus& status) {
  out << "supervisor  " << supervisor::name_of(static_cast<supervisor::State>(status.state));
  if (status.cause != crane_CAUSE_NONE)
    out << " because of " << supervisor::name_of(static_cast<supervisor::Cause>(status.cause)) << ": "
        << remedy(status);
  out << '\n';
  if (status.cause != crane_CAUSE_HOMING_FAILED) return;
  const auto failure = static_cast<supervisor::HomingFailure>(status.homing_failure);
  out << "homing      " << supervisor::name_of(failure) << ": " << supervisor::remedy_for(failure) << '\n';
}

void print_mode(std::ostream& out, const msg::SupervisorStatus& status) {
  const auto mode = static_cast<supervisor::Mode>(status.mode);
  out << "mode        " << supervisor::name_of(mode) << ": " << supervisor::rule_of(mode).purpose << '\n';
}

void print_latch(std::ostream& out, const msg::State& state) {
  if (state.latch_reason == crane_LATCH_NONE) return;
  const auto reason = static_cast<bridge::Reason>(state.latch_reason);
  out << "bridge      stopped the crane: " << bridge::name_of(reason) << ", "
      << bridge::explanation_of(reason) << ": " << bridge::remedy_for(reason) << '\n';
}

std::vector<std::string> silent_processes(const Snapshot& snapshot) {
  const auto heard = [&](const runtime::ComponentSpec& process) {
    return std::ranges::any_of(snapshot.nodes | std::views::values,
                               [&](const msg::NodeStatus& node) { return node.name == process.name; });
  };
  const auto loop = stack::simulated_stack(), with_bridge = stack::hardware_stack();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (heard(loop[i]) || heard(with_bridge[i])) continue;
    names.emplace_back(loop[i].name);
    if (with_bridge[i].name != loop[i].name) names.back() += " or " + std::string{with_bridge[i].name};
  }
  return names;
}

Snapshot listen(bus::Bus& bus, double timeout_s) {
  // Recorder, twin and tools are optional: the snapshot is complete when no new process has reported for this
  // time. With keys, a handshake, which is slow on a busy computer, precedes the discovery.
  const std::int64_t quiet_ns = bus.options().credentials ? 1'500'000'000 : 300'000'000;
  auto nodes = bus.subscriber(topics::node);
  auto supervisors = bus.subscriber(topics::supervisor);
  auto states = bus.subscriber(topics::state);
  auto twins = bus.subscriber(topics::twin);
  auto adaptations = bus.subscriber(topics::adaptation);
  Snapshot snapshot;
  std::int64_t changed_ns = runtime::monotonic_ns();
  int writers = 0;
  std::size_t heard = 0;
  wait_until(bus, timeout_s, [&] {
    while (const auto node = nodes.take()) snapshot.nodes[node->node] = *node;
    bus::take_newest(supervisors, snapshot.supervisor);
    bus::take_newest(states, snapshot.state);
    bus::take_newest(twins, snapshot.twin);
    bus::take_newest(adaptations, snapshot.adaptation);
    const auto now_ns = runtime::monotonic_ns();
    if (nodes.matched() != writers || snapshot.nodes.size() != heard) changed_ns = now_ns;
    writers = nodes.matched(), heard = snapshot.nodes.size();
    const bool twin_heard = twins.matched() == 0 || snapshot.twin;
    const bool adaptation_heard = adaptations.matched() == 0 || snapshot.adaptation;
    return twin_heard && adaptation_heard && snapshot.supervisor && snapshot.state &&
           silent_processes(snapshot).empty() && now_ns - changed_ns > quiet_ns;
  });
  snapshot.other_versions = bus.other_versions();
  return snapshot;
}

Snapshot safety_state(bus::Bus& bus, double timeout_s) {
  // A writer keeps up to 128 samples (1.3 s) for a reader that has not yet discovered it. These samples then
  // arrive at once, the oldest first.
  constexpr std::int64_t kBacklog_ns = 300'000'000;
  std::optional<std::int64_t> first_ns;
  auto supervisors = bus.subscriber(topics::supervisor);
  auto states = bus.subscriber(topics::state);
  Snapshot snapshot;
  wait_until(bus, timeout_s, [&] {
    bus::take_newest(supervisors, snapshot.supervisor);
    bus::take_newest(states, snapshot.state);
    const auto now_ns = runtime::monotonic_ns();
    if (!first_ns && snapshot.supervisor && snapshot.state) first_ns = now_ns;
    return first_ns && now_ns - *first_ns > kBacklog_ns;
  });
  return snapshot;
}

nlohmann::ordered_json to_json(const Snapshot& snapshot) {
  nlohmann::ordered_json result;
  result["nodes"] = nlohmann::ordered_json::array();
  for (const auto& [number, node] : snapshot.nodes) result["nodes"].push_back(to_json(topics::node, node));
  result["unheard"] = silent_processes(snapshot);
  result["supervisor"] = nullptr;
  if (snapshot.supervisor) {
    result["supervisor"] = to_json(topics::supervisor, *snapshot.supervisor);
    result["supervisor"]["remedy"] = remedy(*snapshot.supervisor);
  }
  result["state"] =
      snapshot.state ? to_json(topics::state, *snapshot.state) : nlohmann::ordered_json(nullptr);
  result["twin"] = snapshot.twin ? to_json(topics::twin, *snapshot.twin) : nlohmann::ordered_json(nullptr);
  result["adaptation"] = snapshot.adaptation ? to_json(topics::adaptation, *snapshot.adaptation)
                                             : nlohmann::ordered_json(nullptr);
  result["other_versions"] = nlohmann::ordered_json::array();
  for (const auto& other : snapshot.other_versions)
    result["other_versions"].push_back({{"participant", other.participant}, {"version", other.version}});
  return result;
}

void print(std::ostream& out, const Snapshot& snapshot) {
  print_nodes(out, snapshot);
  out << '\n';
  if (snapshot.supervisor) {
    print_supervisor(out, *snapshot.supervisor);
    print_mode(out, *snapshot.supervisor);
  }
  if (snapshot.state) {
    print_latch(out, *snapshot.state);
    print_axes(out, *snapshot.state);
  }
  if (snapshot.twin) print_twin(out, *snapshot.twin);
  if (snapshot.adaptation) print_adaptation(out, *snapshot.adaptation);
  for (const auto& name : silent_processes(snapshot))
    out << "no status   " << name
        << ": the process does not run, or the network loses its samples; try a longer --timeout, or `crane "
           "doctor`\n";
  for (const auto& other : snapshot.other_versions) out << "version     " << bus::refusal(other) << '\n';
  if (!snapshot.supervisor) out << "supervisor  no status received: the crane cannot move\n";
  if (!snapshot.state) out << "crane/state  no sample received: neither bridge nor plant publishes it\n";
}

}  // namespace crane::cli
