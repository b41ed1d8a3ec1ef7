#include "stack/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace crane::stack {

ServiceManager::ServiceManager() : socket_{std::getenv("NOTIFY_SOCKET")} {
  if (const char* period_us = std::getenv("WATCHDOG_USEC"))
    watchdog_ns_ = std::strtoll(period_us, nullptr, 10) * 1000;
}

void ServiceManager::ready() { notify("READY=1"); }
void ServiceManager::stopping() { notify("STOPPING=1"); }

void ServiceManager::alive(std::int64_t now_ns) {
  if (watchdog_ns_ <= 0 || now_ns < due_ns_) return;
  due_ns_ = now_ns + watchdog_ns_ / 3;
  notify("WATCHDOG=1");
}

void ServiceManager::notify(std::string_view message) const {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (socket_ == nullptr || std::strlen(socket_) >= sizeof to.sun_path) return;
  const auto length = std::strlen(socket_);
  std::memcpy(to.sun_path, socket_, length);
  if (to.sun_path[0] == '@') to.sun_path[0] = '\0';  // abstract socket address, unix(7)
  const int sender = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (sender < 0) return;
  // A manager that does not read must not delay the stop of the stack.
  ::sendto(sender, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&to),
           static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length));
  ::close(sender);
}

}  // namespace crane::stack
