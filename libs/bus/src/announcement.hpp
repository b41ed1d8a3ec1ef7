#pragma once
/// The announcement of a participant in its USER_DATA, which both vendors exchange at discovery: version of
/// the messages, crane, name, process id and host. It can be read even when no topic of the two participants
/// matches.
#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "crane/bus/announcement.hpp"
#include "crane/bus/bus.hpp"

namespace crane::bus {

/// "crane messages=1 crane=NAME participant=NAME process=PID host=HOST"
[[nodiscard]] std::string announcement(const Options& options);

/// The participants of this crane and their announcements. Thread-safe.
class Census {
 public:
  using Key = std::array<std::uint8_t, 16>;

  Census(std::uint32_t version, std::string crane) : version_{version}, crane_{std::move(crane)} {}
  /// Stores the announcement of a participant. Ignores participants without an announcement, of another
  /// crane, and beyond the first kMost.
  void note(const Key& participant, std::string_view user_data);
  void forget(const Key& participant);
  /// The participants whose messages have another version.
  [[nodiscard]] std::vector<OtherVersion> others() const;
  /// "NAME, pid PID on HOST, GUID prefix in hexadecimal"; without an announcement only the prefix. Short,
  /// because the text of an event has at most 255 bytes
  [[nodiscard]] std::string origin_of(const ParticipantId& participant) const;

 private:
  static constexpr std::size_t kMost = 1024;
  const std::uint32_t version_;
  const std::string crane_;
  mutable std::mutex mutex_;
  std::map<Key, Announcement> announced_;
};

}  // namespace crane::bus
