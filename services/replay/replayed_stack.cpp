#include "replay/replayed_stack.hpp"

#include <algorithm>

namespace crane::replay {

InProcessReplay::InProcessReplay(std::span<const runtime::ComponentSpec> components,
                                 const configuration::Rig& rig, const control::Controller& controller)
    : stack_{components, rig, controller},
      configuration_{configuration::digest(rig, controller.name)},
      has_supervisor_{is_output(topics::supervisor.description, components, rig.design)},
      bus_{runtime::memory_options(stack_.network(), "crane_replay", crane_SOURCE_MONITOR)},
      outputs_{bus_, components, rig.design},
      writers_{[this](const std::string& name, crane_Source source, std::uint32_t epoch) {
        auto options = runtime::memory_options(stack_.network(), name, source);
        options.epoch = epoch;
        return bus::Bus{options};
      }} {}

void InProcessReplay::run() {
  stack_.pump();
  outputs_.take();
}

bool InProcessReplay::receive(const RecordedTick& tick) {
  const auto* state = tick.find(topics::state.description);
  if (state == nullptr) return false;
  for (const auto& input : tick.inputs)
    if (!writers_.publish_input(input)) return false;
  // Without the supervisor, another controller may run; the state then carries the configuration of this one.
  if (!writers_.publish_state(*state, has_supervisor_ ? std::nullopt : std::optional{configuration_}))
    return false;
  run();
  if (has_supervisor_) return true;
  const auto* status = tick.find(topics::supervisor.description);
  if (status == nullptr || !writers_.publish_supervisor(*status)) return false;
  run();
  return true;
}

}  // namespace crane::replay
