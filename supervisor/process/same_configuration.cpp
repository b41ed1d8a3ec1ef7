#include "process/same_configuration.hpp"

namespace crane::supervisor {
namespace {

/// @return index in `newest_`; nothing for the supervisor and for a process outside the loop
std::optional<std::size_t> place_of(std::uint32_t source) {
  switch (source) {
    case crane_SOURCE_PLANT:
    case crane_SOURCE_BRIDGE:
      return 0;
    case crane_SOURCE_PLANNER:
      return 1;
    case crane_SOURCE_TRACKING:
      return 2;
    case crane_SOURCE_ANTI_SWING:
      return 3;
    case crane_SOURCE_FRICTION:
      return 4;
    default:
      return std::nullopt;
  }
}

std::string in_words(const msg::NodeStatus& status) {
  return std::string{status.name} + " (process " + std::to_string(status.pid) + ")";
}

}  // namespace

void SameConfiguration::receive() {
  constexpr int kMostPerCall = 64;
  bus::SampleInfo info;
  bool any = false;
  for (int taken = 0; taken < kMostPerCall; ++taken) {
    const auto status = statuses_.take(&info);
    if (!status) break;
    if (!info.valid) continue;
    note(*status);
    any = true;
  }
  if (!any) return;
  auto found = difference();
  if (!found.empty() && difference_.empty())
    node_.error("configuration_differs", found,
                "restart the processes with the same rig file and controller");
  difference_ = std::move(found);
}

void SameConfiguration::note(const msg::NodeStatus& status) {
  const auto place = place_of(status.node);
  if (!place) return;
  auto& newest = newest_[*place];
  if (status.phase != crane_PHASE_STOPPING)
    newest = status;
  else if (newest && newest->header.epoch == status.header.epoch)
    newest.reset();
}

std::string SameConfiguration::difference() const {
  const msg::NodeStatus* leader = nullptr;  // first process with a controller
  for (const auto& status : newest_) {
    if (!status) continue;
    if (status->rig_digest != node_.identity().rig_digest)
      return in_words(*status) + " has another rig file than the supervisor";
    const std::string controller = status->controller;
    if (controller.empty()) continue;
    if (leader == nullptr) leader = &*status;
    if (controller != leader->controller)
      return in_words(*status) + " has the controller " + controller + ", " + in_words(*leader) + " has " +
             leader->controller;
  }
  return "";
}

}  // namespace crane::supervisor
