#pragma once
/// The figures of the dashboard in the text format of Prometheus.
#include <string>

#include "dashboard/model.hpp"

namespace crane::dashboard {

/// Counts of the server.
struct ServerCounts {
  std::size_t viewers = 0, connections = 0;
  std::uint64_t dropped_messages = 0;  ///< samples that were not sent to slow clients
  std::uint64_t slow_clients = 0;
  std::uint64_t lost_samples = 0;  ///< samples dropped because this process was too busy
  std::uint64_t refused_requests = 0;
};

[[nodiscard]] std::string metrics(const Model& model, const ServerCounts& counts, std::int64_t now_ns);

}  // namespace crane::dashboard
