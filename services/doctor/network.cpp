#include "doctor/network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "crane/bus/ports.hpp"
#include "crane/runtime/process.hpp"
#include "observation/traffic.hpp"

namespace crane::doctor {
namespace {

using std::chrono::milliseconds;

std::string list_of(const std::vector<std::string>& all) {
  std::string text;
  for (const auto& one : all) text += (text.empty() ? "" : ", ") + one;
  return text;
}

std::string where(const ExpectedCrane& expected) {
  return "crane '" + expected.crane + "' in domain " + std::to_string(expected.domain) + " on " +
         list_of(expected.interfaces);
}

Finding nobody(const ExpectedCrane& expected, const std::string& code, const std::string& instead,
               const std::string& remedy) {
  return {Grade::problem, "net", code, "nobody publishes for " + where(expected) + instead, remedy};
}

/// @return options with which this command would find the other crane; empty: the same options
std::string options_for(const ExpectedCrane& expected, const std::string& crane, std::uint32_t domain) {
  std::string options;
  if (crane != expected.crane) options += " --crane " + crane;
  if (domain != expected.domain) options += " --domain " + std::to_string(domain);
  return options;
}

std::string code_for(const ExpectedCrane& expected, std::uint32_t domain) {
  return domain != expected.domain ? "wrong_domain" : "wrong_crane";
}

/// One finding for each other crane on this computer.
Findings cranes_on_this_computer(const ExpectedCrane& expected, const std::vector<LocalProcess>& local) {
  Findings findings;
  std::set<std::string> reported;
  for (const auto& process : local) {
    if (!process.in_loop()) continue;
    auto options = options_for(expected, process.crane, process.domain);
    auto code = options.empty() ? "wrong_interface" : code_for(expected, process.domain);
    if (process.interfaces != expected.interfaces)
      for (const auto& interface : process.interfaces) options += " --interface " + interface;
    if (process.secure && !expected.secure) {
      if (options.empty()) code = "wrong_keys";
      options += " --secure DIR";
    }
    if (options.empty() || !reported.insert(options).second) continue;
    findings.push_back(nobody(expected, code,
                              "; on this computer crane '" + process.crane + "' runs in domain " +
                                  std::to_string(process.domain) + " on " + list_of(process.interfaces) +
                                  (process.secure ? ", with keys" : ""),
                              "add" + options));
  }
  return findings;
}

Findings cranes_announced(const ExpectedCrane& expected, const std::vector<Announced>& announced) {
  Findings findings;
  std::set<std::string> reported;
  for (const auto& one : announced) {
    const auto options = options_for(expected, one.said.crane, one.domain);
    if (options.empty() || !reported.insert(options + one.address).second) continue;
    findings.push_back(nobody(expected, code_for(expected, one.domain),
                              "; " + one.said.participant + " of crane '" + one.said.crane +
                                  "' announces itself from " + one.address + " in domain " +
                                  std::to_string(one.domain),
                              "add" + options));
  }
  return findings;
}

}  // namespace

Observed listen_on(bus::Bus& bus, milliseconds duration) {
  Observed observed;
  std::vector<bus::CdrSubscriber> readers;
  for (const auto& topic : topics::kAll) readers.push_back(bus.cdr_subscriber(topic));
  auto nodes = bus.subscriber(topics::node);
  const auto end_ns = runtime::monotonic_ns() + std::chrono::nanoseconds{duration}.count();
  std::vector<std::uint8_t> cdr;
  bus::SampleInfo info;
  while (runtime::monotonic_ns() < end_ns && !runtime::stop_requested()) {
    bus.wait(milliseconds{20});
    for (auto& reader : readers)
      while (reader.take(cdr, &info))
        if (info.valid && reader.topic().name == topics::state.description.name) ++observed.states;
    while (const auto node = nodes.take(&info)) {
      if (!info.valid) continue;
      // A stored status that a new reader receives is old; only the newest status counts.
      const auto now_ns =
          std::chrono::nanoseconds{std::chrono::system_clock::now().time_since_epoch()}.count();
      observed.clock_offset_s[node->name] = static_cast<double>(info.source_time_ns - now_ns) * 1e-9;
      observed.nodes[node->node] = *node;
    }
  }
  for (const auto& reader : readers)
    if (reader.counts().rejected > 0)
      observed.rejected[std::string{reader.topic().name}] = reader.counts().rejected;
  observed.endpoints = bus.found_endpoints();
  std::erase_if(observed.endpoints,
                [&](const auto& one) { return !bus::belongs_to(one, bus.options().crane); });
  observed.other_versions = bus.other_versions();
  return observed;
}

Findings judge_silence(const ExpectedCrane& expected, const Observed& observed,
                       const std::vector<LocalProcess>& local, const std::vector<Announced>& announced) {
  if (!observed.nodes.empty() || observed.states > 0) return {};
  auto findings = cranes_on_this_computer(expected, local);
  std::ranges::move(cranes_announced(expected, announced), std::back_inserter(findings));
  if (findings.empty() && observed.other_versions.empty())
    findings.push_back(
        nobody(expected, "nobody_publishes", ", and no other crane is found",
               "start one with `crane up`; on another computer both sides need --interface, and "
               "where multicast is blocked --peer ADDRESS of the opposite host"));
  return findings;
}

Findings judge_processes_on_bus(const Observed& observed) {
  if (observed.nodes.empty() && observed.states == 0) return {};
  Findings findings;
  constexpr std::array kLoop{crane_SOURCE_PLANNER, crane_SOURCE_TRACKING, crane_SOURCE_ANTI_SWING,
                             crane_SOURCE_FRICTION, crane_SOURCE_SUPERVISOR};
  const auto missing = [&](crane_Source source) { return !observed.nodes.contains(source); };
  const auto absent = [&](const std::string& name) {
    findings.push_back({Grade::problem, "net", "process_missing",
                        name + " is not heard: the crane cannot move",
                        "read the output of `crane up`, then restart the stack"});
  };
  if (missing(crane_SOURCE_PLANT) && missing(crane_SOURCE_BRIDGE)) absent("plant or hardware_bridge");
  for (const auto source : kLoop)
    if (missing(source)) absent(observation::source_name(source));
  for (const auto& [number, node] : observed.nodes) {
    const std::string name = node.name;
    if (node.phase == crane_PHASE_STARTING)
      findings.push_back({Grade::problem, "net", "process_starting",
                          name + " waits for a counterpart: a reader or a writer of its topics is missing",
                          "`crane graph` and `crane status` show which process is missing"});
    if (node.lost_ticks > 0)
      findings.push_back({Grade::advice, "net", "ticks_lost",
                          name + " has lost " + std::to_string(node.lost_ticks) + " of " +
                              std::to_string(node.ticks) + " ticks",
                          "run `crane doctor --rt`: it checks whether the timer of this computer is late"});
    // A status is up to 1 s old. Twin and recorder have no real-time priority.
    constexpr double kClocks_s = 2.5;
    if (const auto offset = observed.clock_offset_s.find(name);
        offset != observed.clock_offset_s.end() && std::abs(offset->second) > kClocks_s)
      findings.push_back(
          {Grade::advice, "net", "clock_skew",
           "the clock of " + name + " is " + std::to_string(std::llround(std::abs(offset->second))) + " s " +
               (offset->second > 0 ? "ahead of" : "behind") + " this computer's, or the process hangs",
           "run chrony on both computers; recordings and faults have these times"});
  }
  if (observed.states == 0)
    findings.push_back({Grade::problem, "net", "no_ticks",
                        "crane/state has no sample: the clock master starts no ticks",
                        "in lockstep `crane run` advances the ticks; in real time restart the stack"});
  const bool complete =
      std::ranges::none_of(findings, [](const Finding& finding) { return finding.grade == Grade::problem; });
  if (complete)
    findings.push_back({Grade::good, "net", "processes",
                        std::to_string(observed.nodes.size()) + " processes are heard" +
                            (findings.empty() ? ", none has lost a tick" : ""),
                        ""});
  return findings;
}

Findings judge_mismatches(const Observed& observed) {
  Findings findings;
  for (const auto& other : observed.other_versions)
    findings.push_back({Grade::problem, "net", "other_version",
                        other.participant + " has messages of version " + std::to_string(other.version) +
                            ", this program has version " + std::to_string(crane_MESSAGES_VERSION) +
                            "; its samples are dropped",
                        "run programs of one release, or give each crane its own --crane or --domain"});
  std::ranges::move(judge_endpoints(observed.endpoints), std::back_inserter(findings));
  if (observed.other_versions.empty())
    for (const auto& [topic, count] : observed.rejected)
      findings.push_back({Grade::problem, "net", "samples_rejected",
                          std::to_string(count) + " samples of " + topic + " had a wrong CRC",
                          "end the program of another release, or check the network"});
  return findings;
}

Findings judge_number_of_participants(const std::vector<LocalProcess>& local, std::uint32_t domain) {
  constexpr std::ptrdiff_t kMost = bus::most_participants();
  const auto count = std::ranges::count(local, domain, &LocalProcess::domain);
  if (count < kMost) return {};
  return {{Grade::problem, "net", "too_many_participants",
           std::to_string(count) + " programs of cranes run in domain " + std::to_string(domain) +
               " of this computer, which has ports for " + std::to_string(kMost),
           "end programs of earlier stacks (`pgrep -a crane`), start cranes with --in-process, or give "
           "them other domains (--domain)"}};
}

}  // namespace crane::doctor
