#pragma once
/// Receives the traffic on an interface of this host, and sends packets.
#include <netinet/in.h>

#include <chrono>
#include <optional>
#include <set>
#include <string>

#include "rtps.hpp"

namespace crane::hostile {

struct Packet {
  sockaddr_in to{};
  Bytes message;
  [[nodiscard]] std::uint16_t port() const { return ntohs(to.sin_port); }
};

/// Receives every RTPS message on one interface. Needs CAP_NET_RAW.
class Ear {
 public:
  explicit Ear(const char* interface = "lo");  ///< @throws std::system_error
  ~Ear();
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;
  [[nodiscard]] static bool permitted();
  [[nodiscard]] std::optional<Packet> next(std::chrono::milliseconds patience);

 private:
  int socket_;
};

/// Sends from an unprivileged socket, as any program on this host can.
class Mouth {
 public:
  Mouth();
  ~Mouth();
  Mouth(const Mouth&) = delete;
  Mouth& operator=(const Mouth&) = delete;
  void send(const Packet& packet);
  [[nodiscard]] std::uint64_t sent() const { return sent_; }

 private:
  int socket_;
  std::uint64_t sent_ = 0;
};

/// UDP ports of a process.
[[nodiscard]] std::set<std::uint16_t> ports_of(pid_t process);
/// Memory of a process [kB]; 0: no such process.
[[nodiscard]] long resident_kb(pid_t process);

}  // namespace crane::hostile
