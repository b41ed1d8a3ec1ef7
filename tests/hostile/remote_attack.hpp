#pragma once
/// A stack without keys on an interface that other hosts reach, and an attacker on another host. The attacker
/// knows what discovery and its own readers receive, and sends to all ports of the stack.
#include <arpa/inet.h>

#include <memory>
#include <optional>
#include <vector>

#include "../interop/two_hosts.hpp"
#include "crane/bus/ports.hpp"
#include "discovery_attack.hpp"

namespace crane::hostile {

using hosts::OnHost;
using hosts::TwoHosts;

class RemoteAttack : public DiscoveryAttack {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts_.ok()) << "cannot make network namespaces with `ip netns`";
    near_.emplace(hosts_.near());
    start(reachable(default_options()));
  }
  void TearDown() override { stack_.reset(); }

  static stack::LaunchOptions reachable(stack::LaunchOptions options) {
    options.bus.interfaces = {TwoHosts::kNear};
    options.bus.insecure = true;
    return options;
  }
  /// Options of a program of the attacker. One process cannot use two interfaces with Cyclone DDS.
  [[nodiscard]] runtime::BusOptions remote() const {
    auto options = stack_->bus_options();
    options.interfaces = {TwoHosts::kFar};
    options.vendor = "fastdds";
    return options;
  }
  /// The ports of all processes of the loop, which discovery tells to every host. Multicast ports belong to
  /// the observer of this test, too, and the observer has no ledger.
  [[nodiscard]] std::vector<sockaddr_in> all_ports() {
    std::vector<sockaddr_in> all;
    for (const char* process : kLoop)
      for (const auto port : ports(process)) {
        if (bus::first_port(kDomain) <= port && port < bus::unicast_port(kDomain, 0)) continue;
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        ::inet_pton(AF_INET, TwoHosts::kNear, &to.sin_addr);
        all.push_back(to);
      }
    return all;
  }
  /// A packet with a sample of the genuine writer, as a reader of the attacker receives it.
  template <class T>
  Bytes overheard(bus::Bus& bus, const topics::Topic<T>& topic) {
    const auto reader = bus.subscriber(topic);
    Ear ear{hosts_.far_device().c_str()};
    const auto end = std::chrono::steady_clock::now() + 5s;
    while (std::chrono::steady_clock::now() < end)
      if (auto packet = ear.next(20ms); packet && find(packet->message, topic)) return packet->message;
    throw std::runtime_error("no such packet heard");
  }

  TwoHosts hosts_;
  std::optional<OnHost> near_;
};

}  // namespace crane::hostile
