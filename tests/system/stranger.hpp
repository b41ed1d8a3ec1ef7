#pragma once
/// A foreign program with the bus of this project: copies the headers of received samples, and writes topics
/// that only a process of the stack may write.
#include <gtest/gtest.h>

#include <optional>

#include "running_stack.hpp"

namespace crane::system_test {

/// Takes the newest sample of one topic, changes it, and publishes it under the identity of its writer.
template <class T>
class Stranger {
 public:
  Stranger(const runtime::BusOptions& options, const topics::Topic<T>& topic, void (*spoil)(T&),
           int epoch_ahead)
      : ear_{runtime::bus_options(options, "stranger", crane_SOURCE_MONITOR, 0)},
        heard_{ear_.subscriber(topic)} {
    using namespace std::chrono_literals;
    const auto end = std::chrono::steady_clock::now() + 5s;
    std::optional<T> sample;
    while (!sample && std::chrono::steady_clock::now() < end) {
      ear_.wait(10ms);
      sample = heard_.take();
    }
    if (!sample) throw std::runtime_error("the stranger hears nothing");
    forged_ = *sample;
    spoil(forged_);
    joined_ns_ = clock_ns(CLOCK_MONOTONIC);
    mouth_.emplace(runtime::bus_options(options, "stranger", forged_.header.source,
                                        forged_.header.epoch + static_cast<std::uint32_t>(epoch_ahead)));
    writer_.emplace(mouth_->publisher(topic));
  }
  /// Time at which this program began to join as a writer.
  [[nodiscard]] std::int64_t joined_ns() const { return joined_ns_; }
  /// Publishes the forged sample for the present tick and the next one.
  void speak() {
    while (const auto sample = heard_.take()) {
      forged_.header.tick = sample->header.tick;
      forged_.header.sample_time_ns = sample->header.sample_time_ns;
    }
    for (int ahead = 0; ahead < 2; ++ahead, ++forged_.header.tick) EXPECT_TRUE(writer_->publish(forged_));
  }

 private:
  bus::Bus ear_;
  bus::Subscriber<T> heard_;
  std::optional<bus::Bus> mouth_;
  std::optional<bus::Publisher<T>> writer_;
  T forged_{};
  std::int64_t joined_ns_ = 0;
};

inline void full_speed(double (&drive_v)[3]) {
  for (double& v : drive_v) v = 5;
}
inline void open_and_push(msg::Command& command) {
  full_speed(command.drive_v);
  for (bool& release : command.brake_release) release = true;
  command.watchdog_permission = true;
}
inline void push(msg::Contribution& contribution) { full_speed(contribution.drive_v); }
inline void ask_for_all(msg::Demand& demand) { full_speed(demand.total_v); }
inline void far_away(msg::Reference& reference) { reference.axis[0].position += 1; }
inline void elsewhere(msg::State& state) {
  state.trolley_position_m += 0.3;
  for (bool& closed : state.brake_closed) closed = false;
}
inline void armed(msg::SupervisorStatus& status) {
  status.state = crane_STATE_RUN;
  status.move.number += 1;
  status.move.kind = crane_REQUEST_MOVE;
  status.move.selected[0] = true;
  status.move.target[0] = 1.2;
}

/// Calls `run(topic, spoil)` for the loop topic with this name ("command").
template <class Run>
void with_forgery_of(std::string_view topic, const Run& run) {
  if (topic == "command") run(topics::command, open_and_push);
  if (topic == "demand") run(topics::demand, ask_for_all);
  if (topic == "tracking") run(topics::tracking, push);
  if (topic == "anti_swing") run(topics::anti_swing, push);
  if (topic == "reference") run(topics::reference, far_away);
  if (topic == "state") run(topics::state, elsewhere);
  if (topic == "supervisor") run(topics::supervisor, armed);
}

}  // namespace crane::system_test
