#pragma once
/// Permissions on a secured bus. A role may write the topics that topics.hpp permits its sources to write,
/// and read every topic of the crane.
#include <optional>
#include <string_view>
#include <vector>

#include "crane/topics.hpp"

namespace crane::security {

struct Role {
  std::string_view name;     ///< "supervisor": the directory of its keys
  std::string_view summary;  ///< for `crane keys show`
  topics::Sources sources;   ///< kinds of process that have this role
};

[[nodiscard]] const std::vector<Role>& roles();
/// @return null when processes of this kind have no role
[[nodiscard]] const Role* role_of(crane_Source source);
[[nodiscard]] const Role* role_named(std::string_view name);
/// Topics that the role may write.
[[nodiscard]] std::vector<std::string_view> writes(const Role& role);

}  // namespace crane::security
