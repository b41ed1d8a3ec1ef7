#pragma once
/// Packets with the GUID of the supervisor's writer.
#include "copied_writer.hpp"
#include "false_supervisor.hpp"

namespace crane::hostile {

/// Commands in the name of the supervisor, as a supervisor that arms would send them.
class FalseCommands {
 public:
  explicit FalseCommands(const Packet& model) : writer_{model, topics::command} {}
  void command(const msg::Header& state) {
    auto command = writer_.model();
    arm_and_push(command, state, ++ticks_);
    writer_.send(command);
  }
  [[nodiscard]] std::uint64_t sent() const { return writer_.sent(); }

 private:
  CopiedWriter<msg::Command> writer_;
  int ticks_ = 0;
};

}  // namespace crane::hostile
