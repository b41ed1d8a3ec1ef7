#include "dashboard/request_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "crane/fields/printable.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/supervisor/modes.hpp"

namespace crane::dashboard {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<const char*, crane_RequestKind>, 9> kKinds{{{"reset", crane_REQUEST_RESET},
                                                                           {"arm", crane_REQUEST_ARM},
                                                                           {"disarm", crane_REQUEST_DISARM},
                                                                           {"stop", crane_REQUEST_STOP},
                                                                           {"estop", crane_REQUEST_ESTOP},
                                                                           {"home", crane_REQUEST_HOME},
                                                                           {"mode", crane_REQUEST_MODE},
                                                                           {"move", crane_REQUEST_MOVE},
                                                                           {"hold", crane_REQUEST_MOVE}}};
constexpr std::array<const char*, plant::kAxes> kTargets{"trolley_m", "slew_rad", "hoist_m"};

void refuse_unknown(const json& body, const std::vector<std::string>& known) {
  for (const auto& [key, value] : body.items())
    if (std::ranges::find(known, key) == known.end())
      throw BadRequest(key.substr(0, 64) + ": this kind of request has no such field");
}

void read_move(const json& body, stack::OperatorRequest& wanted) {
  refuse_unknown(body, {"kind", kTargets[0], kTargets[1], kTargets[2]});
  for (std::size_t i = 0; i < kTargets.size(); ++i) {
    const auto found = body.find(kTargets[i]);
    if (found == body.end()) continue;
    if (!found->is_number() || !std::isfinite(found->get<double>()))
      throw BadRequest(std::string{kTargets[i]} + ": must be a finite number");
    wanted.selected[i] = true;
    wanted.target[i] = found->get<double>();
  }
  if (std::ranges::none_of(wanted.selected, [](bool selected) { return selected; }))
    throw BadRequest("move: give trolley_m, slew_rad or hoist_m");
}

void read_home(const json& body, stack::OperatorRequest& wanted) {
  refuse_unknown(body, {"kind", "axis"});
  const auto names = plant::drive_names();
  const auto axis = body.find("axis");
  const auto found = axis != body.end() && axis->is_string()
                         ? std::ranges::find(names, axis->get<std::string>())
                         : names.end();
  if (found == names.end()) throw BadRequest("axis: must be trolley, slew or hoist");
  wanted.selected[static_cast<std::size_t>(found - names.begin())] = true;
}

void read_reset(const json& body, stack::OperatorRequest& wanted) {
  refuse_unknown(body, {"kind", "confirm_positions"});
  const auto confirm = body.find("confirm_positions");
  if (confirm == body.end()) return;
  if (!confirm->is_boolean()) throw BadRequest("confirm_positions: must be true or false");
  wanted.selected.fill(confirm->get<bool>());
}

void read_mode(const json& body, stack::OperatorRequest& wanted) {
  refuse_unknown(body, {"kind", "mode"});
  const auto mode = body.find("mode");
  const auto found = mode != body.end() && mode->is_string() ? supervisor::find_mode(mode->get<std::string>())
                                                             : std::nullopt;
  if (!found) throw BadRequest("mode: must be " + supervisor::mode_names());
  wanted.mode = static_cast<crane_OperatingMode>(*found);
}

}  // namespace

stack::OperatorRequest operator_request_of(std::string_view text) {
  constexpr int kDeepest = 2;
  std::set<std::string> keys;
  const auto body = json::parse(
      text,
      [&keys](int depth, json::parse_event_t event, json& parsed) {
        if (depth > kDeepest) throw BadRequest("the body is nested too deeply");
        if (event == json::parse_event_t::key && !keys.insert(parsed.get<std::string>()).second)
          throw BadRequest(fields::printable(parsed.get<std::string>()) + ": occurs twice");
        return true;
      },
      false);
  if (!body.is_object()) throw BadRequest("a JSON object is expected");
  const auto kind = body.find("kind");
  const auto found = kind != body.end() && kind->is_string()
                         ? std::ranges::find(kKinds, kind->get<std::string>(),
                                             [](const auto& k) { return std::string{k.first}; })
                         : kKinds.end();
  if (found == kKinds.end())
    throw BadRequest("kind: must be reset, arm, disarm, stop, estop, home, mode, move or hold");
  stack::OperatorRequest wanted{.kind = found->second};
  if (wanted.kind == crane_REQUEST_MOVE && *kind == "move")
    read_move(body, wanted);
  else if (wanted.kind == crane_REQUEST_HOME)
    read_home(body, wanted);
  else if (wanted.kind == crane_REQUEST_RESET)
    read_reset(body, wanted);
  else if (wanted.kind == crane_REQUEST_MODE)
    read_mode(body, wanted);
  else
    refuse_unknown(body, {"kind"});
  return wanted;
}

}  // namespace crane::dashboard
