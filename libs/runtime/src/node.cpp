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
    : bus_{&bus},
      identity_{std::move(identity)},
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
  if (!events_.publish(event)) ++events_refused_;
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
  report_.lost_ticks = counts.lost;
  report_.late_samples = counts.late;
  report_.duplicate_samples = counts.duplicate;
  report_.rejected_samples = rejected;
  if (now_ns < next_beat_ns_ && phase == report_.phase) return;
  next_beat_ns_ = now_ns + kBeatPeriod_ns;
  report_.phase = phase;
  report_.step_mean_us =
      steps_ > 0 ? static_cast<double>(step_sum_ns_) / static_cast<double>(steps_) / 1e3 : 0;
  report_.step_max_us = static_cast<double>(step_max_ns_) / 1e3;
  step_sum_ns_ = step_max_ns_ = 0;
  steps_ = 0;
  if (!status_.publish(report_)) ++events_refused_;
}

void Node::beat(std::int64_t now_ns, const Ports& ports, const JoinCounts& counts) {
  report_.foreign_samples = ports.foreign();
  report_.refused_samples = ports.refused() + events_refused_;
  report_drops(now_ns, ports);
  beat(now_ns, ports.connected() ? crane_PHASE_READY : crane_PHASE_STARTING, counts, ports.rejected());
}

void Node::report_drops(std::int64_t now_ns, const Ports& ports) {
  const bool disputed = ports.disputed(now_ns);
  if (disputed && !dispute_reported_)
    error("second_writer", "second writer on " + ports.dispute(now_ns),
          "this process drops the samples of the second writer: end that writer, or start one of the two "
          "cranes with another --crane or --domain, then `crane reset`");
  dispute_reported_ = disputed;
  if (now_ns < next_beat_ns_) return;
  report_other_versions();
  if (ports.rejected() > rejected_reported_)
    warning(
        "samples_rejected",
        std::to_string(ports.rejected() - rejected_reported_) + " samples had a wrong CRC and were dropped",
        "check the network");
  if (ports.refused() > refused_reported_)
    error("samples_not_sent",
          std::to_string(ports.refused() - refused_reported_) + " samples could not be sent",
          "check the load of this computer and its network interface");
  rejected_reported_ = ports.rejected();
  refused_reported_ = ports.refused();
}

void Node::report_other_versions() {
  const auto others = bus_->other_versions();
  for (std::size_t i = versions_reported_; i < others.size(); ++i)
    error("other_version", bus::refusal(others[i], bus_->options().messages_version),
          "this process drops the samples of that program: end that program");
  versions_reported_ = others.size();
}

void Node::stopping() {
  report_.phase = crane_PHASE_STOPPING;
  if (!status_.publish(report_)) ++events_refused_;
}

}  // namespace crane::runtime
