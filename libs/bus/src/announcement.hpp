#pragma once
/// The announcement of a participant in its USER_DATA, which both vendors exchange at discovery: version of
/// the messages, crane and name. It can be read even when no topic of the two participants matches.
#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "crane/bus/bus.hpp"

namespace crane::bus {

/// "crane messages=1 crane=NAME participant=NAME"
[[nodiscard]] std::string announcement(const Options& options);

/// The participants whose messages have another version. Thread-safe.
class Census {
 public:
  using Key = std::array<std::uint8_t, 16>;

  Census(std::uint32_t version, std::string crane) : version_{version}, crane_{std::move(crane)} {}
  /// Stores the announcement of a participant. Participants without an announcement, of another crane, or of
  /// the same version are ignored.
  void note(const Key& participant, std::string_view user_data);
  void forget(const Key& participant);
  [[nodiscard]] std::vector<OtherVersion> others() const;

 private:
  const std::uint32_t version_;
  const std::string crane_;
  mutable std::mutex mutex_;
  std::map<Key, OtherVersion> others_;
};

}  // namespace crane::bus
