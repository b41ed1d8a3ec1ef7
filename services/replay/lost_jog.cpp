#include "replay/lost_jog.hpp"

#include <algorithm>

namespace crane::replay {

std::optional<msg::Jog> jog_behind(const msg::SupervisorStatus& status, std::uint32_t epoch) {
  const bool deflected = std::ranges::any_of(status.jog_deflection, [](double share) { return share != 0; });
  if (!deflected || status.mode == crane_MODE_MAINTENANCE) return std::nullopt;
  msg::Jog jog{};
  jog.header.tick = status.header.tick;
  jog.header.sample_time_ns = status.header.sample_time_ns;
  jog.header.source = crane_SOURCE_OPERATOR;
  jog.header.epoch = epoch;
  jog.request_id = status.move.request_id;
  std::ranges::copy(status.move.client, jog.client);
  jog.engaged = true;
  std::ranges::copy(status.jog_deflection, jog.deflection);
  return jog;
}

msg::Jog released(msg::Jog jog, const msg::SupervisorStatus& status) {
  jog.header.tick = status.header.tick;
  jog.header.sample_time_ns = status.header.sample_time_ns;
  jog.engaged = false;
  std::ranges::fill(jog.deflection, 0);
  return jog;
}

}  // namespace crane::replay
