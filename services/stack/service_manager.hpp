#pragma once
/// What a service manager (systemd, Type=notify) is told: sd_notify(3) without its library.
#include <cstdint>
#include <optional>
#include <string_view>

namespace crane::stack {

class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET and WATCHDOG_USEC. Without them nothing is told to anybody.
  ServiceManager();
  /// "The stack is ready"; from then on alive() is expected.
  void ready();
  /// Call often; tells the watchdog at a third of its period. The manager stops a stack that is silent.
  void alive(std::int64_t now_ns);
  void stopping();

 private:
  void tell(std::string_view message) const;
  const char* socket_;
  std::int64_t watchdog_ns_ = 0;  ///< 0: no watchdog
  std::int64_t due_ns_ = 0;
};

}  // namespace crane::stack
