#include "process/operator_requests.hpp"

#include <algorithm>

#include "crane/runtime/node.hpp"
#include "process/samples.hpp"
#include "process/ticks.hpp"

namespace crane::supervisor {
namespace {

constexpr double kLongestStart_s = 0.2;  // longest time from the acceptance of a move to its first reference

}  // namespace

OperatorRequests::OperatorRequests(const runtime::Context& context, const Limits& limits)
    : limits_{limits},
      node_{context.node},
      inbox_{context,
             {crane_REQUEST_RESET, crane_REQUEST_ARM, crane_REQUEST_DISARM, crane_REQUEST_MOVE,
              crane_REQUEST_FOLLOW, crane_REQUEST_JOG, crane_REQUEST_STOP, crane_REQUEST_ESTOP,
              crane_REQUEST_HOME, crane_REQUEST_MODE}},
      accepted_{context.ports.output(topics::accepted_request)} {}

void OperatorRequests::collect(TickInput& input, const TickMemory& last, std::int64_t now_ns) {
  // The planner starts its search for the path of an accepted move from the sample of the same tick.
  const PerAxis& position = input.state_arrived ? input.sample.position : last.motion.position;
  due_.clear();
  bus::ParticipantId sender{};
  OncePerTick once;
  while (const auto request = inbox_.take_due(input.tick, now_ns, &sender)) {
    const auto problem = problem_of_due(*request, position, once);
    if (!problem.empty()) {
      answer(*request, false, problem);
      continue;
    }
    if (request->kind == crane_REQUEST_MODE) {
      change_mode(*request, last.machine.state);
      continue;
    }
    if (request->kind == crane_REQUEST_RESET) std::ranges::copy(request->selected, input.confirmed.begin());
    if (request->kind == crane_REQUEST_HOME) input.home_axis = home_axis_of(*request);
    input.requests[static_cast<std::size_t>(*request_of(request->kind))] = true;
    due_.push_back({*request, sender});
  }
  if (stop_requested()) refuse_all_but_stops(input);
  input.speed_share = rule_of(mode_).speed_share;
}

std::string OperatorRequests::problem_of_due(const msg::Request& request, const PerAxis& position,
                                             OncePerTick& once) const {
  auto problem = once.problem_of(request, limits_);
  if (problem.empty()) problem = problem_in_mode(request, mode_, position);
  if (problem.empty()) problem = problem_at(request, limits_, position);
  return problem;
}

void OperatorRequests::change_mode(const msg::Request& request, State state) {
  const auto problem = mode_problem(request, state);
  if (problem.empty() && mode_ != static_cast<Mode>(request.mode)) {
    mode_ = static_cast<Mode>(request.mode);
    node_.info("operating_mode", std::string{"mode "} + name_of(mode_) + ": " + rule_of(mode_).purpose);
  }
  answer(request, problem.empty(), problem);
}

bool OperatorRequests::stop_requested() const {
  return std::ranges::any_of(due_,
                             [](const DueRequest& due) { return runtime::stops_crane(due.request.kind); });
}

void OperatorRequests::refuse_all_but_stops(TickInput& input) {
  std::erase_if(due_, [&](const DueRequest& due) {
    if (runtime::stops_crane(due.request.kind)) return false;
    input.requests[static_cast<std::size_t>(*request_of(due.request.kind))] = false;
    answer(due.request, false,
           "a stop was requested in the same tick: look at the crane and repeat the request");
    return true;
  });
}

void OperatorRequests::take_answers(const TickOutput& output, JogReader& jogs, double now_s) {
  for (const auto& [request, sender] : due_) {
    const auto& verdict = output.answers[static_cast<std::size_t>(*request_of(request.kind))];
    if (moves_axes(request) && verdict.accepted) {
      move_ = accepted_move(request, move_.number + 1);
      ticks_to_take_up_ = ticks_in(kLongestStart_s, limits_.period_s);
      jogs.accepted(request, sender, now_s);
    }
    answer(request, verdict.accepted, verdict.reason);
  }
}

void OperatorRequests::answer(const msg::Request& request, bool accepted, std::string_view reason) {
  answers_.push_back({request, accepted, std::string{reason}});
}

void OperatorRequests::reply(const msg::Header& header) {
  for (const Answer& answer : answers_) {
    if (answer.accepted) {
      msg::AcceptedRequest sample{};
      sample.header = header;
      sample.request = answer.request;
      accepted_.publish(sample);
    }
    inbox_.reply(answer.request, header, answer.accepted, answer.reason);
  }
  answers_.clear();
}

void OperatorRequests::note_reference(const msg::Reference* reference) {
  if (reference != nullptr) {
    reference_moving_ = reference->moving;
    if (reference->move_number == move_.number) ticks_to_take_up_ = 0;
  }
  if (ticks_to_take_up_ > 0) --ticks_to_take_up_;
}

}  // namespace crane::supervisor
