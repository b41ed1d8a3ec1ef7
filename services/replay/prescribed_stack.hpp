#pragma once
/// The components of a stack without its clock master. In each tick, a component steps with the inputs that
/// the recording shows for it, or does not step.
#include <list>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "replay/prescribed_component.hpp"
#include "replay/replayed_stack.hpp"

namespace crane::replay {

class PrescribedStack final : public ReplayedStack {
 public:
  /// @param components  those of loop_components(). @param rig, controller  outlive the stack
  PrescribedStack(std::span<const runtime::ComponentSpec> components, const configuration::Rig& rig,
                  const control::Controller& controller);
  [[nodiscard]] bool receive(const RecordedTick& tick) override;
  [[nodiscard]] const Cdr* find(const topics::Description& topic, std::uint64_t tick) const override;
  void forget_until(std::uint64_t tick) override;
  [[nodiscard]] bool is_prescribed() const override { return true; }
  [[nodiscard]] const std::vector<Received>& repeated() const override { return repeated_; }
  [[nodiscard]] bool infers_inputs_from_outputs() const override { return planners_.size() > 1; }
  [[nodiscard]] std::uint64_t decided_by_outputs() const override { return decided_by_outputs_; }

 private:
  void begin_planner(const RecordedTick& tick);
  void step_laws(const RecordedTick& tick);
  void step_supervisor(const RecordedTick& tick);
  void step_without_state(const StepWithoutState& step);
  void step_planner(const RecordedTick& tick);
  /// @param begun  true: the planner has already received the state. @return samples of the planner
  std::vector<Received> step(PrescribedComponent& planner, bool begun, bool has_status);
  PrescribedComponent& of(crane_Source source) { return components_.at(source); }
  void deliver(PrescribedComponent& component, const topics::Description& topic);
  /// Polls until the component has published a sample, at most twice (runtime::Clock::prescribed).
  void poll_until_stepped(PrescribedComponent& component, std::int64_t now_ns);
  /// @return false when the component has published no sample
  bool collect(PrescribedComponent& component) { return collect(component.take()); }
  bool collect(std::vector<Received> taken);

  bool corrects_reference_;                                 ///< the tracking law reads crane/anti_swing
  std::map<crane_Source, PrescribedComponent> components_;  ///< all but the planner
  /// Copies of the planner in the same state. The first copy steps first. Where the recording does
  /// not show whether the planner had the status, and the first copy (with the status) publishes
  /// another reference than the recorded one, the second copy steps without the status and replaces
  /// the first.
  std::list<PrescribedComponent> planners_;
  std::map<std::string_view, std::map<std::uint64_t, Cdr>> samples_;  ///< by topic and tick
  std::vector<Received> repeated_;
  std::uint64_t tick_ = 0;
  std::int64_t time_ns_ = 0;     ///< sample time of the present tick
  std::int64_t stepped_ns_ = 0;  ///< time of the last step of the supervisor
  std::uint64_t decided_by_outputs_ = 0;
  bool complete_ = true;  ///< false: an input of this tick was neither recorded nor replayed
};

}  // namespace crane::replay
