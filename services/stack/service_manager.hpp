#pragma once
/// Notifies a service manager (systemd, Type=notify): the protocol of sd_notify(3) without its library.
#include <cstdint>
#include <optional>
#include <string_view>

namespace crane::stack {

class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET and WATCHDOG_USEC. Without them all calls have no effect.
  ServiceManager();
  /// Reports that the stack is ready. Afterwards the manager expects alive().
  void ready();
  /// Call often; notifies the watchdog at a third of its period. The manager stops a silent stack.
  void alive(std::int64_t now_ns);
  void stopping();

 private:
  void notify(std::string_view message) const;
  const char* socket_;
  std::int64_t watchdog_ns_ = 0;  ///< 0: no watchdog
  std::int64_t due_ns_ = 0;
};

}  // namespace crane::stack
