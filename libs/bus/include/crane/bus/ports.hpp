#pragma once
/// UDP ports of a DDS domain (OMG DDSI-RTPS 2.2, 9.6.2.3): PB + DG * domain + offset.
#include <cstdint>

namespace crane::bus {

inline constexpr std::uint32_t kPortBase = 7400, kDomainGain = 250;  // PB, DG
/// Offset of the first unicast port of a domain; distance between the first ports of two participants. Each
/// participant has two consecutive ports: the first for discovery, the second for samples.
inline constexpr std::uint32_t kUnicastOffset = 10, kParticipantGain = 2;

/// First port of a domain: discovery by multicast.
[[nodiscard]] constexpr std::uint32_t first_port(std::uint32_t domain) {
  return kPortBase + kDomainGain * domain;
}

/// First of the two unicast ports of a participant: discovery.
[[nodiscard]] constexpr std::uint32_t unicast_port(std::uint32_t domain, std::uint32_t participant) {
  return first_port(domain) + kUnicastOffset + kParticipantGain * participant;
}

/// Number of participants whose unicast ports lie below the first port of the next domain: 120.
[[nodiscard]] constexpr std::uint32_t most_participants() {
  return (kDomainGain - kUnicastOffset) / kParticipantGain;
}

}  // namespace crane::bus
