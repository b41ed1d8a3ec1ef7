#include "dashboard/metrics.hpp"

#include <prometheus/text_serializer.h>

namespace crane::dashboard {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

class Page {
 public:
  void add(const char* name, const char* help, MetricType type) {
    families_.push_back({name, help, type, {}});
  }
  void value(double value, Labels labels = {}) {
    ClientMetric metric;
    metric.label = std::move(labels);
    (families_.back().type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
    families_.back().metric.push_back(std::move(metric));
  }
  void gauge(const char* name, const char* help, double number) {
    add(name, help, MetricType::Gauge);
    value(number);
  }
  void counter(const char* name, const char* help, std::uint64_t number) {
    add(name, help, MetricType::Counter);
    value(static_cast<double>(number));
  }
  [[nodiscard]] std::string text() const { return prometheus::TextSerializer{}.Serialize(families_); }

 private:
  std::vector<MetricFamily> families_;
};

Labels of_topic(std::size_t index) { return {{"topic", std::string{topics::kAll[index].name}}}; }

template <class Value>
void per_topic(Page& page, const char* name, const char* help, MetricType type, const Model& model,
               Value value) {
  page.add(name, help, type);
  for (std::size_t i = 0; i < topics::kAll.size(); ++i)
    if (const std::optional<double> number = value(model.traffic().topic(i)))
      page.value(*number, of_topic(i));
}

void add_topics(Page& page, const Model& model) {
  using Traffic = const observation::TopicTraffic&;
  per_topic(page, "crane_topic_samples_total", "Samples received.", MetricType::Counter, model,
            [](Traffic t) { return static_cast<double>(t.counts.samples); });
  per_topic(page, "crane_topic_lost_total", "Ticks without a sample.", MetricType::Counter, model,
            [](Traffic t) { return static_cast<double>(t.counts.lost); });
  per_topic(page, "crane_topic_rate_hertz", "Rate by the clock of the source.", MetricType::Gauge, model,
            [](Traffic t) { return t.window.samples > 0 ? t.window.rate_hz : std::nullopt; });
  page.add("crane_topic_delay_seconds",
           "From the latching of the encoders to the sending, over the last second.", MetricType::Gauge);
  for (std::size_t i = 0; i < topics::kAll.size(); ++i) {
    const auto& delay = model.traffic().topic(i).delay_us;
    if (!delay) continue;
    for (const auto& [quantile, value] :
         {std::pair{"0.5", delay->p50}, {"0.99", delay->p99}, {"1", delay->max}}) {
      auto labels = of_topic(i);
      labels.push_back({"quantile", quantile});
      page.value(value * 1e-6, std::move(labels));
    }
  }
}

void add_processes(Page& page, const Model& model, std::int64_t now_ns) {
  page.add("crane_process_up", "1: the process reports its status.", MetricType::Gauge);
  for (const auto& [number, heard] : model.traffic().nodes())
    page.value(heard.silent(now_ns) ? 0 : 1, {{"process", heard.status.name}});
  page.add("crane_process_lost_ticks_total", "Ticks with incomplete inputs.", MetricType::Counter);
  for (const auto& [number, heard] : model.traffic().nodes())
    page.value(static_cast<double>(heard.status.lost_ticks), {{"process", heard.status.name}});
}

void add_crane(Page& page, const Model& model) {
  if (const auto& status = model.situation().supervisor()) {
    page.gauge("crane_supervisor_state", "SupervisorState of crane.idl.", static_cast<double>(status->state));
    page.gauge("crane_supervisor_cause", "Cause of crane.idl.", static_cast<double>(status->cause));
  }
  if (const auto& state = model.situation().state()) {
    page.gauge("crane_trolley_position_meters", "Trolley position.", state->trolley_position_m);
    page.gauge("crane_slew_angle_radians", "Slew angle.", state->slew_angle_rad);
    page.gauge("crane_cable_length_meters", "Cable length.", state->cable_length_m);
    page.gauge("crane_swing_radial_radians", "Radial swing.", state->swing_radial_rad);
    page.gauge("crane_swing_tangential_radians", "Tangential swing.", state->swing_tangential_rad);
    page.counter("crane_bridge_overruns_total", "Ticks that began more than half a period late.",
                 state->overruns);
  }
}

}  // namespace

std::string metrics(const Model& model, const ServerCounts& counts, std::int64_t now_ns) {
  Page page;
  add_topics(page, model);
  add_processes(page, model, now_ns);
  add_crane(page, model);
  page.gauge("crane_other_version_programs", "Programs of this crane with another version of the messages.",
             static_cast<double>(model.other_versions().size()));
  page.gauge("crane_dashboard_viewers", "Open WebSockets.", static_cast<double>(counts.viewers));
  page.gauge("crane_dashboard_history_bytes", "Memory of the history.",
             static_cast<double>(model.history().bytes()));
  page.counter("crane_dashboard_dropped_messages_total", "Samples that slow clients did not get.",
               counts.dropped_messages);
  page.counter("crane_dashboard_slow_clients_total", "Clients that were too slow for events.",
               counts.slow_clients);
  page.counter("crane_dashboard_lost_samples_total", "Samples that the dashboard was too busy to take.",
               counts.lost_samples);
  page.counter("crane_dashboard_refused_requests_total", "Requests refused for origin, host or token.",
               counts.refused_requests);
  return page.text();
}

}  // namespace crane::dashboard
