#include "dashboard/situation.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crane/bridge/last_line.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/runtime/request_kinds.hpp"
#include "crane/supervisor/explain.hpp"
#include "crane/supervisor/modes.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::dashboard {
namespace {

using nlohmann::ordered_json;

ordered_json latch_of(const msg::State& state) {
  if (state.latch_reason == crane_LATCH_NONE) return nullptr;
  const auto reason = static_cast<bridge::Reason>(state.latch_reason);
  return {{"reason", bridge::name_of(reason)},
          {"explanation", bridge::explanation_of(reason)},
          {"remedy", bridge::remedy_for(reason)},
          {"final", bridge::is_final(reason)}};
}

ordered_json homing_of(const msg::SupervisorStatus& status) {
  const auto failure = static_cast<supervisor::HomingFailure>(status.homing_failure);
  if (failure == supervisor::HomingFailure::none) return nullptr;
  return {{"failure", supervisor::name_of(failure)}, {"remedy", supervisor::remedy_for(failure)}};
}

ordered_json axes_of(const msg::SupervisorStatus& status, const msg::State* state) {
  auto axes = ordered_json::array();
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    axes.push_back({{"name", plant::kCoordinates[i].name},
                    {"unit", plant::kCoordinates[i].unit},
                    {"present", status.volt_limit_v[i] > 0},
                    {"low_limit", status.low_limit[i]},
                    {"high_limit", status.high_limit[i]},
                    {"volt_limit_v", status.volt_limit_v[i]},
                    {"known", state != nullptr && state->position_known[i]},
                    {"brake_closed", state != nullptr && state->brake_closed[i]}});
  return axes;
}

/// Adds the answer to each request. The supervisor never refuses stop, disarm and estop.
void add_answers(ordered_json& answers, const msg::SupervisorStatus& status, const msg::State* state) {
  for (const auto& line : supervisor::explain(status, state))
    answers.push_back({{"request", line.request}, {"accepted", line.accepted}, {"reason", line.reason}});
  for (const auto* always : {"stop", "disarm", "estop"})
    answers.push_back({{"request", always}, {"accepted", true}, {"reason", ""}});
}

ordered_json move_of(const msg::AcceptedMove& move) {
  if (move.number == 0) return nullptr;
  ordered_json result{{"number", move.number}, {"client", move.client}};
  for (std::size_t i = 0; i < plant::kAxes; ++i)
    result["target"].push_back(move.selected[i] ? ordered_json(move.target[i]) : ordered_json(nullptr));
  return result;
}

}  // namespace

void Situation::add(const observation::Sample& sample) {
  if (msg::SupervisorStatus status; decode(topics::supervisor, sample, status)) {
    supervisor_ = status;
    supervisor_ns_ = sample.arrival_time_ns;
    statuses_.push_back({status.header, supervisor_ns_});
    while (supervisor_ns_ - statuses_.front().arrival_ns > runtime::kRequestLife_ns) statuses_.pop_front();
  } else if (msg::State state; decode(topics::state, sample, state)) {
    state_ = state;
    state_ns_ = sample.arrival_time_ns;
  }
}

std::optional<msg::Header> Situation::status_of(std::string_view id, std::int64_t now_ns) const {
  const auto found = std::find_if(statuses_.rbegin(), statuses_.rend(),
                                  [id](const Arrived& arrived) { return status_id(arrived.header) == id; });
  if (found == statuses_.rend() || now_ns - found->arrival_ns > runtime::kRequestLife_ns) return std::nullopt;
  return found->header;
}

ordered_json Situation::json(std::int64_t now_ns) const {
  if (!hears_supervisor(now_ns))
    return {
        {"heard", false},
        {"state", nullptr},
        {"remedy",
         "no sample of the supervisor arrives: start a stack with `crane up`, or check --crane, --domain, "
         "--interface and --secure of the dashboard"}};
  const auto* state = state_within(observation::kStale_ns, now_ns);
  const auto cause = static_cast<supervisor::Cause>(supervisor_->cause);
  ordered_json result{{"heard", true},
                      {"state", supervisor::name_of(static_cast<supervisor::State>(supervisor_->state))},
                      {"cause", supervisor::name_of(cause)},
                      {"remedy", cause == supervisor::Cause::none ? "" : supervisor::remedy_for(cause)},
                      {"mode", supervisor::name_of(static_cast<supervisor::Mode>(supervisor_->mode))},
                      {"latch", state == nullptr ? ordered_json(nullptr) : latch_of(*state)},
                      {"homing", homing_of(*supervisor_)},
                      {"answers", ordered_json::array()},
                      {"move", move_of(supervisor_->move)},
                      {"axes", axes_of(*supervisor_, state)}};
  add_answers(result["answers"], *supervisor_, state);
  return result;
}

std::string status_id(const msg::Header& header) {
  return std::to_string(header.epoch) + "-" + std::to_string(header.tick);
}

std::string text_of(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace crane::dashboard
