#pragma once
/// Times at which the supervisor steps in real time although inputs are missing. In lockstep, every
/// step has all inputs. In a replay, the recording determines the steps: where the recorded step
/// had no state, the runner polls the supervisor without a state.
#include <cstdint>

#include "crane/runtime/component.hpp"

namespace crane::supervisor {

class StepTiming {
 public:
  StepTiming(double period_s, runtime::Clock clock) : period_s_{period_s}, clock_{clock} {}

  /// The processes discover each other one after the other. The supervisor begins with the first tick that
  /// has all inputs, or 2 s after its first state. Until the first command, the bridge keeps 0 V and closed
  /// brakes.
  /// @param complete  the tick has all inputs
  /// @return true when the supervisor begins with this tick, or has begun
  bool begins(bool complete, std::int64_t now_ns);

  /// Call at a step with a state. Sets the time of the next step if no further state arrives.
  /// @param sampled_ns  local time of the sample
  void stepped(std::int64_t sampled_ns, std::int64_t now_ns);

  /// Call when no tick is complete. After a pause of the computer, samples may have arrived that are not yet
  /// delivered. One pause must not count as several missing ticks; therefore the function extends the wait,
  /// once per step.
  /// @param open  true: a state waits for its demand. The wait then lasts two periods longer:
  ///   normally the tick join finishes this tick first
  /// @return true when the supervisor steps now without a state
  bool is_silent(bool open, std::int64_t now_ns);

  /// Time of the step without a state; runtime::kNever before the first state, in lockstep, and in
  /// a replay while a state waits for its demand.
  [[nodiscard]] std::int64_t due_ns(bool open) const;

 private:
  [[nodiscard]] std::int64_t periods_ns(double periods) const {
    return static_cast<std::int64_t>(periods * period_s_ * 1e9);
  }
  void expect_state_by(std::int64_t time_ns) {
    state_due_ns_ = time_ns;
    wait_extended_ = false;
  }

  double period_s_;
  runtime::Clock clock_;
  std::int64_t state_due_ns_ = runtime::kNever;
  bool begun_ = false;
  bool wait_extended_ = false;  ///< true: the wait of this step has been extended
};

}  // namespace crane::supervisor
