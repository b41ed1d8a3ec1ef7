#pragma once
/// What a stack received and published in one tick of a recording.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "replay/samples.hpp"

namespace crane::replay {

struct Received {
  const topics::Description* topic;
  Cdr cdr;
};

struct RecordedTick {
  std::uint64_t number = 0;
  std::vector<Received> inputs{};             ///< of operators, before the state of this tick, in their order
  std::map<std::string_view, Cdr> samples{};  ///< by name of the topic; loop topics only
  bool begins = false;   ///< the stack began with this tick; its processes were not there before
  bool assumed = false;  ///< not recorded: the crane rested as in the first recorded tick
  std::string ends{};    ///< not empty: why a replay cannot repeat this tick and those after it
  [[nodiscard]] const Cdr* find(const topics::Description& topic) const {
    const auto found = samples.find(topic.name);
    return found == samples.end() ? nullptr : &found->second;
  }
};

/// @return nullptr when the program has no such topic
[[nodiscard]] const topics::Description* topic_named(std::string_view name);
/// @return nothing when the sample is too short
[[nodiscard]] std::optional<std::uint64_t> tick_of(std::span<const std::uint8_t> cdr);

}  // namespace crane::replay
