#pragma once
/// What a participant says of itself in its USER_DATA, which both vendors exchange at discovery.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace crane::bus {

struct Announcement {
  std::uint32_t version = 0;  ///< of its messages
  std::string crane, participant;
  bool operator==(const Announcement&) const = default;
};

/// @return nothing when `user_data` is not that of a program of this project
[[nodiscard]] std::optional<Announcement> parse_announcement(std::string_view user_data);

}  // namespace crane::bus
