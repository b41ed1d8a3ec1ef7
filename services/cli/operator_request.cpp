#include "cli/operator_request.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <vector>

#include "crane/configuration/rig.hpp"

namespace crane::cli {
namespace {

/// First request id of this process, which differs between simultaneous tools, also with the same pid.
std::uint64_t first_id() {
  constexpr std::uint64_t kPidBits = 22, kPidMask = (1U << kPidBits) - 1;
  const auto now_us = static_cast<std::uint64_t>(runtime::monotonic_ns() / 1000);
  return (now_us << kPidBits) | (static_cast<std::uint64_t>(::getpid()) & kPidMask);
}

/// Another program on the bus can prevent every answer, and expired keys prevent the request. Ending the
/// stack needs neither bus nor keys.
std::string without_bus(crane_RequestKind kind) {
  return runtime::stops_crane(kind)
             ? "; to stop the crane without the bus, end `crane up` (Ctrl-C, or `systemctl stop "
               "crane`)"
             : "";
}

class Conversation {
  static constexpr double kReportEvery_s = 3;

 public:
  Conversation(bus::Bus& bus, const stack::OperatorRequest& wanted)
      : bus_{bus},
        wanted_{wanted},
        names_status_{wanted.newest_status.sample_time_ns != 0},
        client_{bus, client_name(), first_id()},
        supervisor_{bus.subscriber(topics::supervisor)} {
    if (wanted.kind == crane_REQUEST_MOVE || wanted.kind == crane_REQUEST_JOG)
      planner_ = bus.subscriber(topics::reference);
  }

  void find_listeners(double timeout_s) {
    if (wait_and_report(timeout_s, [this] { return found(); })) return;
    if (heard_supervisor_ && heard_planner() && probe_at_ns_ > 0)
      throw NoAnswer("the supervisor did not answer within " + std::to_string(static_cast<int>(timeout_s)) +
                     " s: check that its ticks advance (crane status)" + without_bus(wanted_.kind));
    throw NoAnswer((heard_supervisor_ && !heard_planner() ? "no trajectory planner" : "no supervisor") +
                   where_and_remedy(bus_) + without_bus(wanted_.kind));
  }

  Answer exchange(double timeout_s) {
    constexpr std::int64_t kRepeat_ns = 100'000'000;
    std::int64_t repeat_at_ns = 0;
    std::optional<Answer> answer;
    wait_and_report(timeout_s, [&] {
      const auto now_ns = runtime::monotonic_ns();
      if (sent_.empty() || (runtime::is_urgent_stop(wanted_.kind) && now_ns >= repeat_at_ns)) {
        hear_supervisor();
        sent_.push_back(client_.send(wanted_));
        repeat_at_ns = now_ns + kRepeat_ns;
      }
      answer = take_answer();
      return answer.has_value();
    });
    if (!answer && !heard_supervisor_)
      throw NoAnswer("no supervisor" + where_and_remedy(bus_) + without_bus(wanted_.kind));
    if (!answer)
      throw NoAnswer("the supervisor did not answer within " + std::to_string(static_cast<int>(timeout_s)) +
                     " s: check that its ticks advance (crane status)" + without_bus(wanted_.kind));
    return *answer;
  }

 private:
  /// Like wait_until(). For a request that stops the crane, reports every 3 s that no answer has arrived.
  bool wait_and_report(double timeout_s, const std::function<bool()>& poll) {
    for (double left_s = timeout_s; left_s > 0 && !runtime::stop_requested(); left_s -= kReportEvery_s) {
      if (wait_until(bus_, std::min(left_s, kReportEvery_s), poll)) return true;
      if (runtime::stops_crane(wanted_.kind) && left_s > kReportEvery_s)
        std::cerr << "no answer of the supervisor yet" << without_bus(wanted_.kind) << '\n';
    }
    return false;
  }
  void hear_supervisor() {
    while (const auto status = supervisor_.take()) {
      heard_supervisor_ = true;
      if (!names_status_) wanted_.newest_status = status->header;
    }
  }
  [[nodiscard]] bool heard_planner() const { return !planner_ || heard_reference_; }

  /// True when the request can be sent. Many processes read crane/request: a matched reader does not prove
  /// that the supervisor receives it. A request that must not be repeated therefore waits for the answer of
  /// the supervisor to a probe; a move or a session of the stick also for a sample of crane/reference.
  bool found() {
    constexpr std::int64_t kProbeEvery_ns = 50'000'000;
    hear_supervisor();
    while (planner_ && planner_->take()) heard_reference_ = true;
    if (client_.listeners() == 0) return false;
    if (runtime::is_urgent_stop(wanted_.kind)) return true;
    if (client_.answerers() == 0 || !heard_supervisor_ || !heard_planner()) return false;
    client_.receive();
    if (client_.take_reply(stack::OperatorClient::kProbe, crane_SOURCE_SUPERVISOR)) return true;
    if (const auto now_ns = runtime::monotonic_ns(); now_ns >= probe_at_ns_) {
      client_.probe();
      probe_at_ns_ = now_ns + kProbeEvery_ns;
    }
    return false;
  }

  std::optional<Answer> take_answer() {
    client_.receive();
    for (const auto id : sent_)
      if (const auto reply = client_.take_reply(id, crane_SOURCE_SUPERVISOR))
        return Answer{id, reply->accepted, reply->reason};
    return std::nullopt;
  }

  bus::Bus& bus_;
  stack::OperatorRequest wanted_;
  bool names_status_;
  stack::OperatorClient client_;
  bus::Subscriber<msg::SupervisorStatus> supervisor_;
  std::optional<bus::Subscriber<msg::Reference>> planner_;
  bool heard_supervisor_ = false;
  bool heard_reference_ = false;
  std::int64_t probe_at_ns_ = 0;
  std::vector<std::uint64_t> sent_;
};

}  // namespace

bus::Bus open_bus_for(crane_RequestKind kind, const runtime::BusOptions& options) {
  try {
    return open_bus(options, crane_SOURCE_OPERATOR);
  } catch (const configuration::ConfigurationError& error) {
    auto problems = error.problems();
    problems.back() += without_bus(kind);
    throw configuration::ConfigurationError(std::move(problems));
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what() + without_bus(kind));
  }
}

std::string client_name() { return "crane " + std::to_string(::getpid()); }

Patience patience_for(crane_RequestKind kind, bool keys) {
  return keys && runtime::stops_crane(kind) ? kStopWithKeys : Patience{};
}

Answer ask(bus::Bus& bus, const stack::OperatorRequest& wanted) {
  return ask(bus, wanted, patience_for(wanted.kind, bus.options().credentials.has_value()));
}

Answer ask(bus::Bus& bus, const stack::OperatorRequest& wanted, const Patience& patience) {
  Conversation conversation{bus, wanted};
  conversation.find_listeners(patience.find_s);
  // A stop is sent before the writer of the replies is found.
  return conversation.exchange(patience.reply_s +
                               (runtime::is_urgent_stop(wanted.kind) ? patience.find_s : 0));
}

bool stop_crane(bus::Bus& bus, double patience_s) {
  constexpr std::chrono::milliseconds kRepeat{20};
  const auto end_ns = runtime::monotonic_ns() + static_cast<std::int64_t>(patience_s * 1e9);
  stack::OperatorClient client{bus, client_name(), first_id()};
  std::vector<std::uint64_t> sent;
  while (runtime::monotonic_ns() < end_ns) {
    if (client.listeners() > 0) sent.push_back(client.send({.kind = crane_REQUEST_STOP}));
    bus.wait(kRepeat);
    client.receive();
    for (const auto id : sent)
      if (client.take_reply(id, crane_SOURCE_SUPERVISOR)) return true;
  }
  return false;
}

int report(const char* what, const Answer& answer) {
  if (answer.accepted) {
    std::cout << what << ": accepted\n";
    return runtime::kExitDone;
  }
  std::cerr << what << ": refused: " << answer.reason << '\n';
  return runtime::kExitFailed;
}

}  // namespace crane::cli
