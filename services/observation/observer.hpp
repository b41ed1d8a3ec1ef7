#pragma once
/// Takes the samples of every topic. It reads what the tools read; the loop does not notice it.
#include <functional>
#include <vector>

#include "crane/bus/bus.hpp"
#include "observation/sample.hpp"

namespace crane::observation {

class Observer {
 public:
  using Deliver = std::function<void(std::vector<SamplePtr>)>;
  Observer(bus::Bus& bus, Deliver deliver);

  /// Takes and hands on what has arrived. Waits at most 20 ms.
  void poll();

 private:
  bus::Bus& bus_;
  Deliver deliver_;
  std::vector<bus::CdrSubscriber> readers_;
};

/// The clock of Sample::log_time_ns: ns since 1970 when this process began, and monotonic from then on.
[[nodiscard]] std::int64_t log_now_ns();

}  // namespace crane::observation
