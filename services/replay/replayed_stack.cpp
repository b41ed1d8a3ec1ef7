#include "replay/replayed_stack.hpp"

#include <algorithm>
#include <optional>

#include "crane/bus/cdr.hpp"

namespace crane::replay {
namespace {

template <class T>
std::optional<T> decoded(const topics::Topic<T>& topic, const Cdr& cdr) {
  T sample{};
  const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
  if (cdr.size() < bus::kEncapsulation_bytes ||
      !codec.decode(std::span{cdr}.subspan(bus::kEncapsulation_bytes), false, &sample))
    return std::nullopt;
  return sample;
}

bool writes(const runtime::ComponentSpec& component, const topics::Description& topic,
            const control::Design& design) {
  return std::ranges::any_of(component.writes, [&](const auto& write) {
    return write.topic->name == topic.name && runtime::is_written(write, design);
  });
}

}  // namespace

ReplayedStack::ReplayedStack(std::span<const runtime::ComponentSpec> components,
                             const configuration::Rig& rig, const control::Controller& controller)
    : stack_{components, rig, controller},
      configuration_{configuration::digest(rig, controller.name)},
      bus_{runtime::memory_options(stack_.network(), "crane_replay", crane_SOURCE_MONITOR)},
      has_supervisor_{std::ranges::any_of(components, [&rig](const auto& component) {
        return writes(component, topics::supervisor.description, rig.design);
      })} {
  for (const auto& topic : topics::kAll)
    if (topic.every_tick && std::ranges::any_of(components, [&](const auto& component) {
          return writes(component, topic, rig.design);
        }))
      outputs_.emplace(
          topic.name,
          Output{bus_.cdr_subscriber(topic, runtime::loop_endpoint(runtime::Clock::lockstep)), {}});
}

bus::Bus ReplayedStack::bus_of(const msg::Header& header, const std::string& name) const {
  auto options = runtime::memory_options(stack_.network(), name, header.source);
  options.epoch = header.epoch;
  return bus::Bus{options};
}

ReplayedStack::Operator& ReplayedStack::operator_of(const msg::Header& header, const std::string& client) {
  const auto key = std::to_string(header.source) + ' ' + std::to_string(header.epoch) + ' ' + client;
  const auto found = operators_.find(key);
  if (found != operators_.end()) return found->second;
  auto bus = bus_of(header, client);
  auto requests = bus.publisher(topics::request);
  auto jogs = bus.publisher(topics::jog);
  return operators_.emplace(key, Operator{std::move(bus), std::move(requests), std::move(jogs)})
      .first->second;
}

template <class T>
bool ReplayedStack::publish(std::unique_ptr<Outside<T>>& outside, const topics::Topic<T>& topic,
                            const Cdr& cdr) {
  auto sample = decoded(topic, cdr);
  if (!sample) return false;
  // The recorded state gets the configuration of the replayed components; otherwise the components would
  // detect a difference when another controller runs.
  if constexpr (requires { sample->configuration; })
    if (!has_supervisor_) sample->configuration = configuration_;
  if (!outside) {
    auto bus = bus_of(sample->header, "recorded_" + std::string{topic.description.name});
    auto publisher = bus.publisher(topic, runtime::loop_endpoint(runtime::Clock::lockstep));
    outside = std::make_unique<Outside<T>>(Outside<T>{std::move(bus), std::move(publisher)});
  }
  return outside->publisher.publish(*sample);
}

bool ReplayedStack::deliver(const Received& input) {
  if (const auto request = input.topic->name == topics::request.description.name
                               ? decoded(topics::request, input.cdr)
                               : std::nullopt)
    return operator_of(request->header, request->client).requests.publish(*request);
  if (const auto jog =
          input.topic->name == topics::jog.description.name ? decoded(topics::jog, input.cdr) : std::nullopt)
    return operator_of(jog->header, jog->client).jogs.publish(*jog);
  return false;
}

void ReplayedStack::run() {
  stack_.pump();
  for (auto& [name, output] : outputs_) {
    Cdr cdr;
    while (const auto header = output.reader.take(cdr)) output.samples[header->tick] = cdr;
  }
}

bool ReplayedStack::receive(const RecordedTick& tick) {
  const auto* state = tick.find(topics::state.description);
  if (state == nullptr) return false;
  for (const auto& input : tick.inputs)
    if (!deliver(input)) return false;
  if (!publish(clock_master_, topics::state, *state)) return false;
  run();
  if (has_supervisor_) return true;
  const auto* status = tick.find(topics::supervisor.description);
  if (status == nullptr || !publish(supervisor_, topics::supervisor, *status)) return false;
  run();
  return true;
}

const Cdr* ReplayedStack::find(const topics::Description& topic, std::uint64_t tick) const {
  const auto output = outputs_.find(topic.name);
  if (output == outputs_.end()) return nullptr;
  const auto found = output->second.samples.find(tick);
  return found == output->second.samples.end() ? nullptr : &found->second;
}

void ReplayedStack::forget_until(std::uint64_t tick) {
  for (auto& [name, output] : outputs_)
    output.samples.erase(output.samples.begin(), output.samples.upper_bound(tick));
}

}  // namespace crane::replay
