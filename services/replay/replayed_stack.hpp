#pragma once
/// The components of a stack without its clock master. They receive recorded samples: in this process over a
/// memory bus, or as processes over DDS (process_stack.hpp).
#include <span>
#include <string>

#include "crane/runtime/in_process.hpp"
#include "replay/recorded_run.hpp"
#include "replay/recorded_writers.hpp"
#include "replay/replayed_outputs.hpp"

namespace crane::replay {

class ReplayedStack {
 public:
  virtual ~ReplayedStack() = default;
  /// Delivers the inputs of operators, then crane/state, then crane/supervisor when no component of the stack
  /// writes this topic. Afterwards all components wait for the next tick. @return false when a sample
  /// cannot be decoded
  [[nodiscard]] virtual bool receive(const RecordedTick& tick) = 0;
  /// @return sample that the stack published in the tick; null: none
  [[nodiscard]] virtual const Cdr* find(const topics::Description& topic, std::uint64_t tick) const = 0;
  virtual void forget_until(std::uint64_t tick) = 0;
  /// True: the components step as RecordedTick::steps states. False: they step in lockstep.
  [[nodiscard]] virtual bool is_prescribed() const { return false; }
  /// Ticks in which the recorded outputs decided whether a component had an input.
  [[nodiscard]] virtual std::uint64_t decided_by_outputs() const { return 0; }
  /// True while the recorded outputs can decide: a second copy of the planner is left
  /// (PrescribedStack).
  [[nodiscard]] virtual bool infers_inputs_from_outputs() const { return false; }
  /// Second and later samples of this tick, from steps of the supervisor without a state.
  [[nodiscard]] virtual const std::vector<Received>& repeated() const {
    static const std::vector<Received> none;
    return none;
  }
};

class InProcessReplay final : public ReplayedStack {
 public:
  /// @param rig, controller  outlive the stack
  InProcessReplay(std::span<const runtime::ComponentSpec> components, const configuration::Rig& rig,
                  const control::Controller& controller);
  [[nodiscard]] bool receive(const RecordedTick& tick) override;
  [[nodiscard]] const Cdr* find(const topics::Description& topic, std::uint64_t tick) const override {
    return outputs_.find(topic, tick);
  }
  void forget_until(std::uint64_t tick) override { outputs_.forget_until(tick); }

 private:
  void run();

  runtime::InProcessStack stack_;
  std::uint32_t configuration_;  ///< of the replayed components
  bool has_supervisor_;          ///< true: the supervisor is a component of the stack
  bus::Bus bus_;
  ReplayedOutputs outputs_;
  RecordedWriters writers_;
};

}  // namespace crane::replay
