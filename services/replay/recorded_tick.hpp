#pragma once
/// Inputs and outputs of a stack in one tick of a recording.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "replay/samples.hpp"
#include "replay/steps.hpp"

namespace crane::replay {

struct Received {
  const topics::Description* topic;
  Cdr cdr;
};

/// A step of the supervisor without a new state. Its samples carry the number of the last tick.
struct StepWithoutState {
  std::vector<Received> inputs{};  ///< inputs of operators before the step
  std::optional<Cdr> command{};    ///< nothing: not recorded
  Cdr status{};
  std::int64_t after_ns = 0;  ///< time since the previous step of the supervisor
};

struct RecordedTick {
  std::uint64_t number = 0;
  std::vector<Received> inputs{};             ///< inputs of operators before the state of this tick, in order
  std::map<std::string_view, Cdr> samples{};  ///< by name of the topic; loop topics only
  std::map<std::string_view, std::int64_t> published_ns{};  ///< clock of the writer, by name of the topic
  Steps steps{};
  std::optional<Cdr> next_reference{};            ///< reference of the next tick; nothing: not recorded
  std::vector<StepWithoutState> without_state{};  ///< steps of the supervisor after the step of this tick
  bool begins = false;                            ///< true: the stack started with this tick
  bool assumed = false;     ///< true: not recorded, assumed at rest as in the first recorded tick
  std::string irregular{};  ///< irregularity that only a prescribed stack can repeat; empty: none
  std::string ends{};       ///< reason why a replay cannot repeat this tick and all later ones; empty: none
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
