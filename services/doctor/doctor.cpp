#include "doctor/doctor.hpp"

#include <algorithm>
#include <future>
#include <iterator>

#include "crane/configuration/rig.hpp"
#include "doctor/hardware.hpp"
#include "doctor/interfaces.hpp"
#include "doctor/network.hpp"
#include "doctor/real_time.hpp"
#include "stack/data_files.hpp"

namespace crane::doctor {
namespace {

using std::chrono::milliseconds;

void add(Findings& findings, Findings more) { std::ranges::move(more, std::back_inserter(findings)); }

milliseconds duration_of(const Options& options) {
  return milliseconds{static_cast<std::int64_t>(options.duration_s * 1e3)};
}

/// Without --interface, the doctor listens for announcements on every network.
std::vector<std::string> addresses_of(const std::vector<Interface>& own) {
  std::vector<std::string> addresses;
  for (const auto& interface : own)
    if (interface.multicast && interface.up) addresses.push_back(interface.address);
  return addresses;
}

/// Longest period of an announcement: Cyclone DDS announces after 0.8 of its lease of 10 s (libs/bus,
/// cyclone/domain.cpp).
constexpr milliseconds kLongestAnnouncement{8'500};

Findings examine_network(const Options& options) {
  const auto own = own_interfaces();
  const bool unicast = !options.bus.peers.empty() || !options.bus.discovery_server.empty();
  auto findings = judge_interfaces(options.bus.interfaces, unicast, own, try_multicast);
  const auto local = local_processes();
  add(findings, judge_processes(local, options.bus.crane, options.bus.domain));
  add(findings, judge_number_of_participants(local, options.bus.domain));
  const bool usable = std::ranges::none_of(findings, [](const Finding& finding) {
    return finding.code == "interface_unknown" || finding.code == "interface_down";
  });
  if (!usable) return findings;  // no participant could be created
  bus::Bus bus{
      runtime::bus_options(options.bus, "crane_doctor", crane_SOURCE_MONITOR, runtime::random_epoch())};
  auto announcements = std::async(
      std::launch::async, [&] { return listen_for_announcements(addresses_of(own), duration_of(options)); });
  const auto observed = listen_on(bus, duration_of(options));
  auto announced = announcements.get();
  const ExpectedCrane expected{options.bus.crane, options.bus.domain, options.bus.interfaces,
                               !options.bus.secure.empty()};
  auto silence = judge_silence(expected, observed, local, announced);
  if (silence.size() == 1 && silence.front().code == "nobody_publishes" && !addresses_of(own).empty()) {
    announced = listen_for_announcements(addresses_of(own), kLongestAnnouncement);
    silence = judge_silence(expected, observed, local, announced);
  }
  add(findings, std::move(silence));
  add(findings, judge_processes_on_bus(observed));
  add(findings, judge_mismatches(observed));
  return findings;
}

Findings examine_real_time(const Options& options, double period_s) {
  const auto permissions = try_permissions(options.priority);
  auto findings = judge_permissions(permissions);
  add(findings, judge_buffers(read_buffers()));
  add(findings, judge_lateness(measure_lateness(period_s, duration_of(options), options.priority), period_s));
  return findings;
}

}  // namespace

Findings examine(const Options& options) {
  const auto rig = configuration::load_rig(stack::find_rig(options.rig));
  Findings findings;
  if (options.network) add(findings, examine_network(options));
  if (options.real_time) add(findings, examine_real_time(options, rig.period_s));
  if (options.hardware) add(findings, examine_board(rig));
  return findings;
}

}  // namespace crane::doctor
