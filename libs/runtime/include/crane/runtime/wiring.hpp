#pragma once
/// The wiring of a stack as data: every component declares the topics it reads and writes, and what for. The
/// host gives a component exactly these endpoints (ports.hpp). The start-up check, the check for a second
/// writer, `crane graph` and the tables in the documents are made from the same declarations.
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
  /// Controllers that need this input; null: all of them.
  bool (*needed_by)(const control::Controller&) = nullptr;
};

/// One output of a component.
struct Write {
  const topics::Description* topic;
  std::string_view purpose;
  /// The component reports ready only when somebody reads this output.
  bool needs_reader = true;
};

/// What a process of the stack is. One of these per component.
struct ComponentSpec {
  std::string_view name;     ///< "tracking"
  std::string_view program;  ///< "crane_tracking"
  std::string_view summary;
  crane_Source source;   ///< written into the header of every sample
  bool runs_controller;  ///< its law depends on --controller
  std::vector<Read> reads;
  std::vector<Write> writes;  ///< besides crane/node and crane/event, which every component writes
  std::unique_ptr<Component> (*make)(const Context&);
};

[[nodiscard]] inline bool is_needed(const Read& read, const control::Controller& controller) {
  return read.needed_by == nullptr || read.needed_by(controller);
}

}  // namespace crane::runtime
