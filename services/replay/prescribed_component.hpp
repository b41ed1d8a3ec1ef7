#pragma once
/// One component with a memory network of its own. The replay decides which samples it receives, and when it
/// is polled.
#include <cstdint>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "crane/runtime/hosted_component.hpp"
#include "crane/runtime/in_process.hpp"
#include "replay/recorded_writers.hpp"

namespace crane::replay {

class PrescribedComponent {
 public:
  /// @param rig, controller  outlive the component
  PrescribedComponent(const runtime::ComponentSpec& spec, const configuration::Rig& rig,
                      const control::Controller& controller);

  /// Delivers a sample of a loop topic. @return false when it cannot be decoded
  [[nodiscard]] bool deliver(const topics::Description& topic, const Cdr& cdr);
  /// Delivers a request or a sample of crane/jog. @return false when it cannot be decoded
  [[nodiscard]] bool deliver(const Received& input) { return operators_.publish_input(input); }
  /// Polls once. The time never runs backwards.
  void poll(std::int64_t now_ns);
  [[nodiscard]] std::int64_t wake_at_ns() { return hosted_.component().wake_at_ns(); }
  /// Takes what the component has published on loop topics, in the order of each topic.
  [[nodiscard]] std::vector<Received> take();

 private:
  struct Writer {
    bus::Bus bus;
    bus::CdrPublisher publisher;
  };
  struct Reader {
    const topics::Description* topic;
    bus::CdrSubscriber subscriber;
  };
  [[nodiscard]] bus::Bus bus_of(const std::string& name, crane_Source source, std::uint32_t epoch) const;

  std::shared_ptr<bus::MemoryNetwork> network_;
  bus::Bus bus_;
  runtime::HostedComponent hosted_;
  bus::Bus observer_;
  std::vector<Reader> outputs_;
  std::map<std::string_view, Writer> inputs_;  ///< by topic
  RecordedWriters operators_;
  std::int64_t now_ns_ = 0;
};

}  // namespace crane::replay
