#pragma once
/// Samples that the replayed components publish on loop topics, by topic and tick.
#include <cstdint>
#include <map>
#include <span>
#include <string_view>

#include "crane/bus/bus.hpp"
#include "crane/control/law.hpp"
#include "crane/runtime/wiring.hpp"
#include "replay/samples.hpp"

namespace crane::replay {

/// @return true when one of the components writes the topic
[[nodiscard]] bool is_output(const topics::Description& topic,
                             std::span<const runtime::ComponentSpec> components,
                             const control::Design& design);

class ReplayedOutputs {
 public:
  ReplayedOutputs(bus::Bus& bus, std::span<const runtime::ComponentSpec> components,
                  const control::Design& design);
  /// Takes the samples that have arrived.
  void take();
  /// @return nothing when no sample of the tick has arrived
  [[nodiscard]] const Cdr* find(const topics::Description& topic, std::uint64_t tick) const;
  void forget_until(std::uint64_t tick);
  /// Names of the topics without a sample of the tick, separated by ", "; "" when none is missing.
  [[nodiscard]] std::string missing(std::uint64_t tick) const;

 private:
  struct Output {
    bus::CdrSubscriber reader;
    std::map<std::uint64_t, Cdr> samples;  ///< by tick
  };
  std::map<std::string_view, Output> outputs_;
};

}  // namespace crane::replay
