#include "crane/runtime/node.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>

#ifndef CRANE_VERSION
#error "CRANE_VERSION is set by the build"
#endif

namespace crane::runtime {
namespace {
constexpr std::int64_t kBeatPeriod_ns = 1'000'000'000;
}

Node::Node(bus::Bus& bus, NodeIdentity identity)
    : identity_{std::move(identity)},
      status_{bus.publisher(topics::node)},
      events_{bus.publisher(topics::event)} {
  report_.node = static_cast<std::uint32_t>(bus.options().source);
  report_.pid = static_cast<std::uint32_t>(::getpid());
  assign(report_.name, identity_.name);
  assign(report_.vendor, bus::to_string(bus.options().vendor));
  assign(report_.version, CRANE_VERSION);
  assign(report_.controller, identity_.controller);
}

void Node::info(std::string_view code, std::string_view what) {
  spdlog::info("{}: {}", identity_.name, what);
  publish_event(crane_SEVERITY_INFO, code, what, "");
}

void Node::warning(std::string_view code, std::string_view what, std::string_view remedy) {
  spdlog::warn("{}: {}{}{}", identity_.name, what, remedy.empty() ? "" : "; ", remedy);
  publish_event(crane_SEVERITY_WARNING, code, what, remedy);
}

void Node::error(std::string_view code, std::string_view what, std::string_view remedy) {
  spdlog::error("{}: {}{}{}", identity_.name, what, remedy.empty() ? "" : "; ", remedy);
  publish_event(crane_SEVERITY_ERROR, code, what, remedy);
}

void Node::publish_event(crane_Severity severity, std::string_view code, std::string_view what,
                         std::string_view remedy) {
  msg::Event event{};
  event.header = report_.header;
  event.severity = severity;
  assign(event.node, identity_.name);
  assign(event.code, code);
  assign(event.what, what);
  assign(event.remedy, remedy);
  events_.publish(event);
}

void Node::stepped(std::uint64_t tick, std::int64_t sample_time_ns, std::int64_t step_ns) {
  report_.header.tick = tick;
  report_.header.sample_time_ns = sample_time_ns;
  step_sum_ns_ += step_ns;
  step_max_ns_ = std::max(step_max_ns_, step_ns);
  ++steps_;
  ++report_.ticks;
}

void Node::beat(std::int64_t now_ns, crane_NodePhase phase, const JoinCounts& counts,
                std::uint64_t rejected) {
  if (now_ns < next_beat_ns_ && phase == report_.phase) return;
  next_beat_ns_ = now_ns + kBeatPeriod_ns;
  report_.phase = phase;
  report_.lost_ticks = counts.lost;
  report_.late_samples = counts.late;
  report_.duplicate_samples = counts.duplicate;
  report_.rejected_samples = rejected;
  report_.step_mean_us =
      steps_ > 0 ? static_cast<double>(step_sum_ns_) / static_cast<double>(steps_) / 1e3 : 0;
  report_.step_max_us = static_cast<double>(step_max_ns_) / 1e3;
  step_sum_ns_ = step_max_ns_ = 0;
  steps_ = 0;
  status_.publish(report_);
}

}  // namespace crane::runtime
