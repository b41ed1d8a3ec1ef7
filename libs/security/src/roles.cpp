#include "crane/security/roles.hpp"

#include <algorithm>

namespace crane::security {

const std::vector<Role>& roles() {
  using topics::only;
  static const std::vector<Role> all{
      {"supervisor", "safety states and the command gate", only(crane_SOURCE_SUPERVISOR)},
      {"bridge", "hardware bridge, simulated plant", only(crane_SOURCE_BRIDGE, crane_SOURCE_PLANT)},
      {"planner", "trajectory planner", only(crane_SOURCE_PLANNER)},
      {"tracking", "tracking law", only(crane_SOURCE_TRACKING)},
      {"anti_swing", "anti-swing law", only(crane_SOURCE_ANTI_SWING)},
      {"friction_compensation", "friction compensation", only(crane_SOURCE_FRICTION)},
      {"twin", "live twin", only(crane_SOURCE_TWIN)},
      {"recorder", "recorder: reports its own health", only(crane_SOURCE_RECORDER)},
      {"operator", "tools that send requests: arm, move, stop ...", only(crane_SOURCE_OPERATOR)},
      {"monitor", "tools that only read", only(crane_SOURCE_MONITOR)}};
  return all;
}

const Role* role_of(crane_Source source) {
  const auto found = std::ranges::find_if(
      roles(), [&](const Role& role) { return (role.sources & topics::only(source)) != 0; });
  return found == roles().end() ? nullptr : &*found;
}

const Role* role_named(std::string_view name) {
  const auto found = std::ranges::find(roles(), name, &Role::name);
  return found == roles().end() ? nullptr : &*found;
}

std::vector<std::string_view> writes(const Role& role) {
  std::vector<std::string_view> names;
  for (const auto& topic : topics::kAll)
    if ((topic.writers & role.sources) != 0) names.push_back(topic.name);
  return names;
}

}  // namespace crane::security
