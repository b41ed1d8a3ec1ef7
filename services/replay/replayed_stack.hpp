#pragma once
/// The components of a stack without its clock master. They receive recorded samples over a memory bus.
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "crane/runtime/in_process.hpp"
#include "replay/recorded_run.hpp"

namespace crane::replay {

class ReplayedStack {
 public:
  /// @param rig, controller  outlive the stack
  ReplayedStack(std::span<const runtime::ComponentSpec> components, const configuration::Rig& rig,
                const control::Controller& controller);

  /// Delivers the inputs of operators, then crane/state, then crane/supervisor when no component of the stack
  /// writes this topic. Afterwards all components wait for the next tick. @return false when a sample
  /// cannot be decoded
  [[nodiscard]] bool receive(const RecordedTick& tick);
  /// @return what the stack has published; nothing when it has published no sample of the tick
  [[nodiscard]] const Cdr* find(const topics::Description& topic, std::uint64_t tick) const;
  void forget_until(std::uint64_t tick);
  /// The missing inputs of each component.
  [[nodiscard]] std::string waiting_for() const { return stack_.waiting_for(); }

 private:
  /// A writer outside the stack. Its samples have its source and start-up number.
  template <class T>
  struct Outside {
    bus::Bus bus;
    bus::Publisher<T> publisher;
  };
  /// All samples of one client come from one participant: the supervisor accepts crane/jog from the
  /// participant that requested the session.
  struct Operator {
    bus::Bus bus;
    bus::Publisher<msg::Request> requests;
    bus::Publisher<msg::Jog> jogs;
  };
  struct Output {
    bus::CdrSubscriber reader;
    std::map<std::uint64_t, Cdr> samples;  ///< by tick
  };
  [[nodiscard]] bus::Bus bus_of(const msg::Header& header, const std::string& name) const;
  [[nodiscard]] Operator& operator_of(const msg::Header& header, const std::string& client);
  template <class T>
  bool publish(std::unique_ptr<Outside<T>>& outside, const topics::Topic<T>& topic, const Cdr& cdr);
  bool deliver(const Received& input);
  void run();

  runtime::InProcessStack stack_;
  std::uint32_t configuration_;  ///< of the replayed components
  bus::Bus bus_;
  std::map<std::string_view, Output> outputs_;
  std::unique_ptr<Outside<msg::State>> clock_master_;
  std::unique_ptr<Outside<msg::SupervisorStatus>> supervisor_;
  bool has_supervisor_;  ///< true: the supervisor is a component of the stack
  std::map<std::string, Operator> operators_;
};

}  // namespace crane::replay
