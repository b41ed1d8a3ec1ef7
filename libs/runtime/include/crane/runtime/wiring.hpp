#pragma once
/// The wiring of a stack as data: every component declares the topics that it reads and writes, with the
/// purpose of each. The runner permits only these endpoints (ports.hpp). The start-up check, the check for
/// a second writer, `crane graph` and the tables in the documents use the same declarations.
#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "crane/control/law.hpp"
#include "crane/topics.hpp"

namespace crane::runtime {

class Component;
struct Context;

/// One input of a component.
struct Read {
  const topics::Description* topic;
  std::string_view purpose;
  /// True for the controllers that need this input; null: all controllers need it.
  bool (*needed_by)(const control::Controller&) = nullptr;
};

/// One output of a component.
struct Write {
  const topics::Description* topic;
  std::string_view purpose;
  /// True: the component reports PHASE_READY only when this output has a reader.
  bool needs_reader = true;
  /// True for the designs with which the component writes this output; null: for all designs.
  bool (*written_with)(const control::Design&) = nullptr;
};

/// Description of one component. `crane up` starts one process per ComponentSpec.
struct ComponentSpec {
  std::string_view name;     ///< "tracking"
  std::string_view program;  ///< "crane_tracking"
  std::string_view summary;
  crane_Source source;   ///< Header.source of every sample of the component
  bool runs_controller;  ///< true: the component depends on --controller
  std::vector<Read> reads;
  std::vector<Write> writes;  ///< without crane/node and crane/event, which every component writes
  std::unique_ptr<Component> (*make)(const Context&);
};

[[nodiscard]] inline bool is_needed(const Read& read, const control::Controller& controller) {
  return read.needed_by == nullptr || read.needed_by(controller);
}

[[nodiscard]] inline bool is_written(const Write& write, const control::Design& design) {
  return write.written_with == nullptr || write.written_with(design);
}

/// @return true when the process of `spec` may write the topic
[[nodiscard]] inline bool writes(const ComponentSpec& spec, std::string_view topic) {
  return topic == topics::node.description.name || topic == topics::event.description.name ||
         std::ranges::any_of(spec.writes, [&](const Write& write) { return write.topic->name == topic; });
}

}  // namespace crane::runtime
