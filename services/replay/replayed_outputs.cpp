#include "replay/replayed_outputs.hpp"

#include <algorithm>

#include "crane/runtime/ports.hpp"

namespace crane::replay {

bool is_output(const topics::Description& topic, std::span<const runtime::ComponentSpec> components,
               const control::Design& design) {
  return std::ranges::any_of(components, [&](const auto& component) {
    return std::ranges::any_of(component.writes, [&](const auto& write) {
      return write.topic->name == topic.name && runtime::is_written(write, design);
    });
  });
}

ReplayedOutputs::ReplayedOutputs(bus::Bus& bus, std::span<const runtime::ComponentSpec> components,
                                 const control::Design& design) {
  for (const auto& topic : topics::kAll)
    if (topic.every_tick && is_output(topic, components, design))
      outputs_.emplace(
          topic.name,
          Output{bus.cdr_subscriber(topic, runtime::loop_endpoint(runtime::Clock::lockstep)), {}});
}

void ReplayedOutputs::take() {
  for (auto& [name, output] : outputs_) {
    Cdr cdr;
    while (const auto header = output.reader.take(cdr)) output.samples[header->tick] = cdr;
  }
}

const Cdr* ReplayedOutputs::find(const topics::Description& topic, std::uint64_t tick) const {
  const auto output = outputs_.find(topic.name);
  if (output == outputs_.end()) return nullptr;
  const auto found = output->second.samples.find(tick);
  return found == output->second.samples.end() ? nullptr : &found->second;
}

void ReplayedOutputs::forget_until(std::uint64_t tick) {
  for (auto& [name, output] : outputs_)
    output.samples.erase(output.samples.begin(), output.samples.upper_bound(tick));
}

std::string ReplayedOutputs::missing(std::uint64_t tick) const {
  std::string names;
  for (const auto& [name, output] : outputs_)
    if (!output.samples.contains(tick)) names += (names.empty() ? "" : ", ") + std::string{name};
  return names;
}

}  // namespace crane::replay
