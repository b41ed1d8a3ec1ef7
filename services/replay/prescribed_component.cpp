#include "replay/prescribed_component.hpp"

#include <algorithm>

#include "replay/replayed_outputs.hpp"

namespace crane::replay {

PrescribedComponent::PrescribedComponent(const runtime::ComponentSpec& spec, const configuration::Rig& rig,
                                         const control::Controller& controller)
    : network_{bus::make_memory_network()},
      bus_{runtime::memory_options(network_, std::string{spec.program}, spec.source)},
      hosted_{bus_, spec, rig, controller, runtime::Clock::prescribed},
      observer_{runtime::memory_options(network_, "crane_replay", crane_SOURCE_MONITOR)},
      operators_{[this](const std::string& name, crane_Source source, std::uint32_t epoch) {
        return bus_of(name, source, epoch);
      }} {
  for (const auto& topic : topics::kAll)
    if (topic.every_tick && is_output(topic, {&spec, 1}, rig.design))
      outputs_.push_back({&topic, observer_.cdr_subscriber(topic)});
}

bus::Bus PrescribedComponent::bus_of(const std::string& name, crane_Source source,
                                     std::uint32_t epoch) const {
  auto options = runtime::memory_options(network_, name, source);
  options.epoch = epoch;
  return bus::Bus{options};
}

bool PrescribedComponent::deliver(const topics::Description& topic, const Cdr& cdr) {
  auto found = inputs_.find(topic.name);
  if (found == inputs_.end()) {
    const auto header = header_of(cdr);
    if (!header) return false;
    auto bus = bus_of("recorded_" + std::string{topic.name}, header->source, header->epoch);
    auto publisher = bus.cdr_publisher(topic);
    found = inputs_.emplace(topic.name, Writer{std::move(bus), std::move(publisher)}).first;
  }
  return found->second.publisher.publish(cdr);
}

void PrescribedComponent::poll(std::int64_t now_ns) {
  now_ns_ = std::max(now_ns_, now_ns);
  (void)hosted_.component().poll(now_ns_);
}

std::vector<Received> PrescribedComponent::take() {
  std::vector<Received> taken;
  Cdr cdr;
  for (auto& output : outputs_)
    while (output.subscriber.take(cdr)) taken.push_back({output.topic, std::move(cdr)});
  return taken;
}

}  // namespace crane::replay
