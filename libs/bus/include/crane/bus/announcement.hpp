#pragma once
/// Announcement of a participant in its USER_DATA, which both vendors exchange at discovery.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace crane::bus {

struct Announcement {
  std::uint32_t version = 0;  ///< MESSAGES_VERSION of the program
  std::string crane, participant;
  std::uint32_t pid = 0;  ///< process id; 0: not announced
  std::string host{};
  bool operator==(const Announcement&) const = default;
};

/// @return nothing when `user_data` does not come from a program of this project
[[nodiscard]] std::optional<Announcement> parse_announcement(std::string_view user_data);

}  // namespace crane::bus
