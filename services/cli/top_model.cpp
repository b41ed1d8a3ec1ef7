#include "cli/top_model.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/snapshot.hpp"
#include "crane/bridge/last_line.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::cli {
namespace {

using nlohmann::ordered_json;

void keep_largest(TopModel::Swing& largest, double angle_rad, std::uint64_t tick) {
  if (std::abs(angle_rad) > std::abs(largest.angle_rad)) largest = {angle_rad, tick};
}

ordered_json json_of(const TopModel::Swing& swing) {
  return {{"angle_rad", swing.angle_rad}, {"tick", swing.tick}};
}

ordered_json json_of(const msg::SupervisorStatus& status) {
  return {{"state", supervisor::name_of(static_cast<supervisor::State>(status.state))},
          {"cause", supervisor::name_of(static_cast<supervisor::Cause>(status.cause))},
          {"remedy", remedy(status)}};
}

}  // namespace

void TopModel::add(const observation::SamplePtr& sample) {
  traffic_.add(*sample);
  faults_.add(*sample);
  if (msg::SupervisorStatus status; decode(topics::supervisor, *sample, status)) {
    supervisor_ = status;
    supervisor_ns_ = sample->arrival_time_ns;
  }
  if (msg::State state; decode(topics::state, *sample, state)) {
    state_ = state;
    state_ns_ = sample->arrival_time_ns;
    keep_largest(radial_, state.swing_radial_rad, state.header.tick);
    keep_largest(tangential_, state.swing_tangential_rad, state.header.tick);
  }
}

bool TopModel::poll(std::int64_t now_ns, std::int64_t log_now_ns) {
  faults_.poll(now_ns, log_now_ns, traffic_, no_history_);
  if (!traffic_.poll(now_ns)) return false;
  std::size_t heard_topics = 0;
  for (std::size_t i = 0; i < trends_.size(); ++i) {
    const auto& topic = traffic_.topic(i);
    heard_topics += topic.counts.samples > 0 ? 1 : 0;
    const bool silent = topic.window.samples == 0;
    const double rate_hz = silent ? 0 : topic.window.rate_hz.value_or(0);
    trends_[i].push_back(topic.delay_us ? topic.delay_us->p99 : rate_hz);
    if (trends_[i].size() > kMostTrend) trends_[i].pop_front();
  }
  settled_ = heard_topics == std::exchange(heard_topics_, heard_topics) && heard_topics > 0;
  return true;
}

bool TopModel::complete() const {
  const auto& nodes = traffic_.nodes();
  return settled_ && supervisor_ && state_ &&
         std::ranges::all_of(nodes, [](const auto& node) { return node.second.tick_rate_hz.has_value(); });
}

std::int64_t TopModel::age_ns(std::int64_t now_ns) const {
  return std::max(supervisor_ ? now_ns - supervisor_ns_ : 0, state_ ? now_ns - state_ns_ : 0);
}

ordered_json TopModel::json(std::int64_t now_ns) const {
  ordered_json result{{"supervisor", nullptr}, {"latch", nullptr}, {"tick", nullptr}};
  if (supervisor_) {
    result["supervisor"] = json_of(*supervisor_);
    result["supervisor"]["age_s"] = static_cast<double>(now_ns - supervisor_ns_) * 1e-9;
  }
  if (state_) {
    result["latch"] = bridge::name_of(static_cast<bridge::Reason>(state_->latch_reason));
    result["tick"] = state_->header.tick;
  }
  result["largest_swing"] = {{"radial", json_of(radial_)}, {"tangential", json_of(tangential_)}};
  result.update(faults_.json());
  result.update(traffic_.json(now_ns));
  return result;
}

}  // namespace crane::cli
