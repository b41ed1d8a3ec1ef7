#pragma once
/// UDP ports of a DDS domain (OMG DDSI-RTPS 2.2, 9.6.2.3: PB + DG domain + offsets).
#include <cstdint>

namespace crane::bus {

inline constexpr std::uint32_t kPortBase = 7400, kDomainGain = 250;

/// First port of a domain: discovery by multicast.
[[nodiscard]] constexpr std::uint32_t first_port(std::uint32_t domain) {
  return kPortBase + kDomainGain * domain;
}

}  // namespace crane::bus
