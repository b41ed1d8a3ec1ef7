#include "doctor/interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace crane::doctor {
namespace {

std::string text_of(const in_addr& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  ::inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

class Datagrams {
 public:
  Datagrams() : descriptor_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {}
  ~Datagrams() { ::close(descriptor_); }
  Datagrams(const Datagrams&) = delete;
  Datagrams& operator=(const Datagrams&) = delete;
  operator int() const { return descriptor_; }  // NOLINT: a descriptor

 private:
  int descriptor_;
};

}  // namespace

std::vector<Interface> own_interfaces() {
  std::vector<Interface> found;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return found;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    found.push_back({.name = i->ifa_name,
                     .address = text_of(reinterpret_cast<const sockaddr_in*>(i->ifa_addr)->sin_addr),
                     .up = (i->ifa_flags & IFF_UP) != 0,
                     .carrier = (i->ifa_flags & IFF_RUNNING) != 0,
                     .multicast = (i->ifa_flags & IFF_MULTICAST) != 0});
  }
  ::freeifaddrs(list);
  return found;
}

Multicast try_multicast(const std::string& address) {
  constexpr int kPatience_ms = 500;
  const Datagrams receiver, sender;
  sockaddr_in group{};
  group.sin_family = AF_INET;
  ::inet_pton(AF_INET, kDiscoveryGroup, &group.sin_addr);
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  ::inet_pton(AF_INET, address.c_str(), &membership.imr_interface);
  socklen_t size = sizeof group;
  if (::bind(receiver, reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0 ||
      ::getsockname(receiver, reinterpret_cast<sockaddr*>(&group), &size) != 0 ||
      ::setsockopt(receiver, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0 ||
      ::setsockopt(sender, IPPROTO_IP, IP_MULTICAST_IF, &membership.imr_interface,
                   sizeof membership.imr_interface) != 0)
    return Multicast::send_refused;
  std::array<unsigned char, 16> sent{}, received{};
  if (::getrandom(sent.data(), sent.size(), 0) != static_cast<ssize_t>(sent.size()) ||
      ::sendto(sender, sent.data(), sent.size(), 0, reinterpret_cast<const sockaddr*>(&group), sizeof group) <
          0)
    return Multicast::send_refused;
  pollfd waiting{.fd = receiver, .events = POLLIN, .revents = 0};
  while (::poll(&waiting, 1, kPatience_ms) == 1)
    if (::recv(receiver, received.data(), received.size(), 0) == static_cast<ssize_t>(sent.size()) &&
        received == sent)
      return Multicast::passes;
  return Multicast::not_heard;
}

Finding unknown_address(const std::string& address, const std::vector<Interface>& own) {
  std::string all;
  for (const auto& interface : own)
    all += (all.empty() ? "" : ", ") + interface.address + " (" + interface.name + ")";
  return {Grade::problem, "net", "interface_unknown",
          "--interface " + address + " is no address of this computer", "choose one of " + all};
}

Finding down(const Interface& interface) {
  return {Grade::problem, "net", "interface_down",
          "the interface " + interface.name + " of " + interface.address +
              (interface.up ? " has no carrier" : " is down"),
          interface.up ? "connect its cable, or check the device at the other end"
                       : "`ip link set " + interface.name + " up`"};
}

Finding multicast_finding(const Interface& interface, Multicast result) {
  const std::string where = " on " + interface.name + " (" + interface.address + ")";
  const std::string peers = "or start every program with --peer ADDRESS of the opposite host";
  switch (result) {
    case Multicast::passes:
      return {Grade::good, "net", "multicast", "multicast passes" + where, ""};
    case Multicast::send_refused:
      return {Grade::problem, "net", "multicast_refused", "the kernel refuses multicast" + where,
              "`ip link set " + interface.name +
                  " multicast on` and check the route of 239.255.0.1 (`ip route get "
                  "239.255.0.1`), " +
                  peers};
    case Multicast::not_heard:
      break;
  }
  return {Grade::problem, "net", "multicast_blocked",
          "multicast to " + std::string{kDiscoveryGroup} + " does not come back" + where +
              ": a firewall drops it",
          "permit UDP 7400 to 33000 from the crane's network (`nft list ruleset`), " + peers};
}

}  // namespace crane::doctor
