#pragma once
/// Receives the samples of every topic, without effect on the control loop.
#include <functional>
#include <vector>

#include "crane/bus/bus.hpp"
#include "observation/sample.hpp"

namespace crane::observation {

class Observer {
 public:
  using Deliver = std::function<void(std::vector<SamplePtr>)>;
  Observer(bus::Bus& bus, Deliver deliver);

  /// Passes on the samples that have arrived. Waits at most 20 ms.
  void poll();

 private:
  bus::Bus& bus_;
  Deliver deliver_;
  std::vector<bus::CdrSubscriber> readers_;
};

/// The clock of Sample::log_time_ns: wall clock (ns since 1970) at the start of this process plus monotonic
/// time.
[[nodiscard]] std::int64_t log_now_ns();

}  // namespace crane::observation
