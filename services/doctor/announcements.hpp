#pragma once
/// Participants of every domain, from what they announce by multicast (RTPS 2.5, 8.5.3 SPDP): the doctor
/// hears a crane in a domain that it has not joined.
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/bus/announcement.hpp"

namespace crane::doctor {

struct Announced {
  std::string address;  ///< of the sender
  std::uint32_t domain = 0;
  bus::Announcement said;
  bool operator==(const Announced&) const = default;
};

/// The announcement of this project's programs in a datagram. @return nothing for any other datagram
[[nodiscard]] std::optional<bus::Announcement> announcement_in(std::span<const std::uint8_t> datagram);

/// Listens in all domains on the interfaces with these addresses; each participant is returned once. Hears
/// nothing of participants that discover by unicast (loop-back, --peer).
[[nodiscard]] std::vector<Announced> listen_for_announcements(const std::vector<std::string>& addresses,
                                                              std::chrono::milliseconds duration);

}  // namespace crane::doctor
