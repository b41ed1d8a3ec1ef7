#pragma once
/// Checks the network interfaces of --interface: the address belongs to this computer, the interface is up,
/// multicast passes.
#include <string>
#include <vector>

#include "doctor/finding.hpp"

namespace crane::doctor {

/// Multicast group of DDS discovery (RTPS 2.5, 9.6.2.4.1).
inline constexpr const char* kDiscoveryGroup = "239.255.0.1";

struct Interface {
  std::string name, address;
  bool up = false, carrier = false, multicast = false;
  [[nodiscard]] bool loop_back() const { return address.starts_with("127."); }
};
/// Interfaces with an IPv4 address.
[[nodiscard]] std::vector<Interface> own_interfaces();

enum class Multicast : std::uint8_t {
  passes,        ///< the datagram came back
  send_refused,  ///< the kernel refused to send it
  not_heard      ///< the datagram did not come back
};
/// Sends a datagram to the discovery group on the interface, and checks that it comes back through the input
/// rules (firewall) of this computer.
[[nodiscard]] Multicast try_multicast(const std::string& address);

/// @param passes  returns the result of try_multicast(); not called for interfaces without multicast
template <class TryMulticast>
[[nodiscard]] Findings judge_interfaces(const std::vector<std::string>& wanted, bool unicast_peers,
                                        const std::vector<Interface>& own, TryMulticast passes);

// Parts of judge_interfaces().
[[nodiscard]] Finding unknown_address(const std::string& address, const std::vector<Interface>& own);
[[nodiscard]] Finding down(const Interface& interface);
[[nodiscard]] Finding multicast_finding(const Interface& interface, Multicast result);

template <class TryMulticast>
Findings judge_interfaces(const std::vector<std::string>& wanted, bool unicast_peers,
                          const std::vector<Interface>& own, TryMulticast passes) {
  Findings findings;
  for (const auto& address : wanted) {
    const Interface* found = nullptr;
    for (const auto& interface : own)
      if (interface.address == address) found = &interface;
    if (found == nullptr)
      findings.push_back(unknown_address(address, own));
    else if (!found->up || !found->carrier)
      findings.push_back(down(*found));
    else if (!found->loop_back() && !unicast_peers)
      findings.push_back(
          multicast_finding(*found, found->multicast ? passes(address) : Multicast::send_refused));
  }
  return findings;
}

}  // namespace crane::doctor
