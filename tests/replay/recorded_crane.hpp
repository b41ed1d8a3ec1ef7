#pragma once
/// A simulated crane in one process, in lockstep, with an operator who acts between ticks, and its recording.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "../recording/temporary_directory.hpp"
#include "crane/bus/seal.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/runtime/node.hpp"
#include "crane/runtime/tick_join.hpp"
#include "crane/supervisor/states.hpp"
#include "experiments/rig_at_start_file.hpp"
#include "experiments/tick_log.hpp"
#include "stack/operator_client.hpp"
#include "stack/stack.hpp"

namespace crane::replay_test {

inline const char* const kClient = "operator";

class RecordedCrane {
 public:
  RecordedCrane(const std::filesystem::path& file, const std::string& rig, const std::string& controller)
      : rig_{configuration::load_rig(CRANE_RIGS "/" + rig + ".toml")},
        controller_{runtime::chosen_controller(controller, rig_)},
        log_{file},
        stack_{specs(), rig_, controller_},
        bus_{runtime::memory_options(stack_.network(), kClient, crane_SOURCE_OPERATOR)},
        operator_{bus_, kClient, 1},
        jogs_{bus_.publisher(topics::jog)},
        samples_{{.in_order = true, .depth = 256}, loop_reader(topics::state),
                 loop_reader(topics::reference),   loop_reader(topics::tracking),
                 loop_reader(topics::anti_swing),  loop_reader(topics::demand),
                 loop_reader(topics::command),     loop_reader(topics::supervisor)} {
    log_.describe({{"clock", "lockstep"}, {"controller", std::string{controller_.name}}, {"rig", rig_.name}},
                  experiments::rig_at_start_text(rig_));
  }

  /// Network of the stack, for a recorder. @param poll  called after every tick
  const std::shared_ptr<bus::MemoryNetwork>& observed_by(std::function<void()> poll) {
    poll_ = std::move(poll);
    return stack_.network();
  }

  [[nodiscard]] std::string rig_text() const { return experiments::rig_at_start_text(rig_); }

  void tick() {
    const auto until = std::max<std::uint64_t>(next_, 1);  // the plant starts with two ticks
    operator_.send({.kind = crane_REQUEST_ADVANCE, .until_tick = until});
    while (next_ <= until) {
      const bool worked = stack_.pump();
      while (samples_.poll(0) == runtime::JoinResult::complete) log_tick();
      ASSERT_TRUE(worked || next_ > until) << stack_.waiting_for();
    }
    if (poll_) poll_();
  }
  void run(double seconds) {
    for (auto left = std::lround(seconds / rig_.period_s); left > 0; --left) tick();
  }
  void run_until(crane_SupervisorState state, double longest_s) {
    for (double s = 0; s < longest_s && status_.state != state; s += rig_.period_s) tick();
    ASSERT_EQ(status_.state, state) << "cause: " << cause();
  }
  /// Sends a request between two ticks, and expects that the supervisor accepts it.
  void ask(const stack::OperatorRequest& wanted) {
    const auto id = operator_.send(wanted);
    log_.receive(topics::request, sealed(topics::request, operator_.last_sent()));
    tick();
    operator_.receive();
    const auto reply = operator_.take_reply(id, crane_SOURCE_SUPERVISOR);
    ASSERT_TRUE(reply.has_value());
    ASSERT_TRUE(reply->accepted) << reply->reason;
    last_id_ = id;
  }
  void ask(crane_RequestKind kind) { ask(stack::OperatorRequest{.kind = kind}); }
  /// Leads the crane from power-on to HOLD.
  void arm() {
    run(1.3);
    ask(crane_REQUEST_RESET);
    run(1.1);
    ask(crane_REQUEST_ARM);
    run_until(crane_STATE_HOLD, 2);
  }
  /// Deflects the stick of the session that was requested last, in every tick.
  void deflect(const std::array<double, 3>& deflection, double seconds) {
    for (auto left = std::lround(seconds / rig_.period_s); left > 0; --left) {
      msg::Jog jog{};
      jog.header.tick = next_ - 1;
      jog.request_id = last_id_;
      runtime::assign(jog.client, kClient);
      jog.engaged = true;
      std::ranges::copy(deflection, jog.deflection);
      ASSERT_TRUE(jogs_.publish(jog));
      log_.receive(topics::jog, sealed(topics::jog, jog));
      tick();
    }
  }
  [[nodiscard]] std::string cause() const {
    return supervisor::name_of(static_cast<supervisor::Cause>(status_.cause));
  }
  [[nodiscard]] const msg::SupervisorStatus& status() const { return status_; }
  /// Closes the recording. @return number of its ticks
  std::uint64_t finish() {
    log_.close();
    return next_;
  }

 private:
  void log_tick() {
    log_.add({samples_.get<0>(), samples_.get<1>(), samples_.get<2>(), samples_.get<3>(), samples_.get<4>(),
              samples_.get<5>(), samples_.get<6>()});
    status_ = *samples_.get<6>();
    ++next_;
  }
  static const std::vector<runtime::ComponentSpec>& specs() {
    static const auto all = stack::simulated_stack();
    return all;
  }
  template <class T>
  std::shared_ptr<runtime::LoopReader<T>> loop_reader(const topics::Topic<T>& topic) {
    return runtime::loop_reader(bus_, topic, runtime::loop_endpoint(runtime::Clock::lockstep));
  }
  template <class T>
  T sealed(const topics::Topic<T>& topic, T sample) const {
    bus::seal(topic.description, &sample, bus_.options().source, bus_.options().epoch);
    return sample;
  }

  std::function<void()> poll_;
  configuration::Rig rig_;
  const control::Controller& controller_;
  experiments::TickLog log_;
  runtime::InProcessStack stack_;
  bus::Bus bus_;
  stack::OperatorClient operator_;
  bus::Publisher<msg::Jog> jogs_;
  runtime::TickJoin<msg::State, msg::Reference, msg::Contribution, msg::Contribution, msg::Demand,
                    msg::Command, msg::SupervisorStatus>
      samples_;
  msg::SupervisorStatus status_{};
  std::uint64_t next_ = 0, last_id_ = 0;
};

/// Decides about one message of a copy, and may change its data. @return false to omit the message
using Change = std::function<bool(const recording::Message& message, std::vector<std::uint8_t>& data)>;

/// Copies a recording with changes that its checksums do not show.
inline void copy_changed(const std::filesystem::path& from, const std::filesystem::path& to,
                         const Change& change, const recording::Metadata* origin = nullptr) {
  recording::McapReader reader{from};
  recording::McapWriter writer{to, {.chunk_bytes = 1U << 14U}};
  const auto channels = recording::add_topic_channels(writer);
  for (const auto& record : reader.metadata())
    writer.metadata(record.name, origin != nullptr ? *origin : record.entries);
  for (const auto& each : reader.attachments())
    writer.attachment(each.name, each.media_type, each.time_ns, each.data);
  reader.for_each({}, [&](const recording::Message& message) {
    std::vector<std::uint8_t> data{message.data.begin(), message.data.end()};
    if (change(message, data))
      writer.message(channels[message.channel->id], message.sequence, message.log_time_ns,
                     message.publish_time_ns, data);
    return true;
  });
  writer.close();
}

}  // namespace crane::replay_test
