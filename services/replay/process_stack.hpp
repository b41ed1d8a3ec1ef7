#pragma once
/// The components of a stack as processes over DDS, in lockstep, in a crane of their own. They receive the
/// recorded samples of clock master and operators.
#include <map>
#include <string>
#include <vector>

#include "crane/files/temporary_directory.hpp"
#include "replay/replayed_stack.hpp"
#include "stack/child_processes.hpp"
#include "stack/launch.hpp"

namespace crane::replay {

struct ProcessOptions {
  runtime::BusOptions bus{};                     ///< bus.vendor: DDS of the processes not in `vendors`
  std::map<std::string, std::string> vendors{};  ///< DDS vendor by component name
};

class ProcessReplay final : public ReplayedStack {
 public:
  /// Writes the rig file of the run for the processes, which start with the first tick.
  ProcessReplay(std::vector<runtime::ComponentSpec> components, const RecordedRun& run,
                const ProcessOptions& options);
  ~ProcessReplay() override;
  ProcessReplay(const ProcessReplay&) = delete;
  ProcessReplay& operator=(const ProcessReplay&) = delete;

  /// @throws std::runtime_error when a process ends, or does not answer within 10 s
  [[nodiscard]] bool receive(const RecordedTick& tick) override;
  [[nodiscard]] const Cdr* find(const topics::Description& topic, std::uint64_t tick) const override {
    return outputs_.find(topic, tick);
  }
  void forget_until(std::uint64_t tick) override { outputs_.forget_until(tick); }

 private:
  void start(const Cdr& first_state);
  /// Samples of different topics may overtake each other. Therefore the function returns after the supervisor
  /// has received the sample of the stick, or has confirmed that the request is scheduled for the tick.
  bool deliver(const Received& input, std::uint64_t tick);
  void schedule(RecordedWriters::Operator& sender, const msg::Request& request);
  bool is_scheduled(const msg::Request& request);
  template <class Condition>
  void until(Condition condition, const std::string& what);

  std::vector<runtime::ComponentSpec> components_;
  files::TemporaryDirectory directory_;  ///< with the rig file
  stack::LaunchOptions launch_;
  stack::ChildProcesses children_;
  bus::Bus bus_;
  bus::Subscriber<msg::Reply> replies_;
  ReplayedOutputs outputs_;
  RecordedWriters writers_;
  bool started_ = false;
};

}  // namespace crane::replay
