#include "cli/tool_bus.hpp"

#include <chrono>

namespace crane::cli {

bus::Bus open_bus(const runtime::BusOptions& options, crane_Source source) {
  runtime::install_stop_signals();
  const auto epoch = runtime::random_epoch();
  return bus::Bus{runtime::bus_options(options, "crane_tool", source, epoch)};
}

std::string where_and_remedy(const bus::Options& options) {
  std::string interfaces;
  for (const auto& interface : options.interfaces) interfaces += (interfaces.empty() ? "" : ", ") + interface;
  return " for crane '" + options.crane + "' in domain " + std::to_string(options.domain) + " on " +
         interfaces +
         ": either no stack runs (start one with crane up), or --crane, --domain, --interface or --secure "
         "differ from the stack's";
}

std::string where_and_remedy(bus::Bus& bus) {
  const auto others = bus.other_versions();
  return others.empty() ? where_and_remedy(bus.options()) : ": " + bus::refusal(others.front());
}

bool wait_until(bus::Bus& bus, double timeout_s, const std::function<bool()>& poll) {
  constexpr std::int64_t kLongest_ns = 20'000'000;  // matched endpoints and signals do not wake Bus::wait()
  const auto end_ns = runtime::monotonic_ns() + static_cast<std::int64_t>(timeout_s * 1e9);
  while (!runtime::stop_requested()) {
    if (poll()) return true;
    const auto left_ns = end_ns - runtime::monotonic_ns();
    if (left_ns <= 0) return false;
    bus.wait(std::chrono::nanoseconds{std::min(left_ns, kLongest_ns)});
  }
  return false;
}

}  // namespace crane::cli
