#pragma once
/// Compares the processes found on the bus with the expected ones, and finds the cause of each difference.
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"
#include "doctor/announcements.hpp"
#include "doctor/endpoints.hpp"
#include "doctor/finding.hpp"
#include "doctor/processes.hpp"

namespace crane::doctor {

/// Observations of the doctor as a participant of the requested crane.
struct Observed {
  std::map<std::uint32_t, msg::NodeStatus> nodes;  ///< by node number
  std::map<std::string, double> clock_offset_s;    ///< by process: clock of its host - clock of this one
  std::uint64_t states = 0;                        ///< samples of crane/state
  std::map<std::string, std::uint64_t> rejected;   ///< by topic: samples with a wrong CRC
  std::vector<bus::FoundEndpoint> endpoints;       ///< endpoints of the other participants of this crane
  std::vector<bus::OtherVersion> other_versions;
};
[[nodiscard]] Observed listen_on(bus::Bus& bus, std::chrono::milliseconds duration);

/// Requested crane and domain, and properties of this computer.
struct ExpectedCrane {
  std::string crane;
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces;
  bool secure = false;
};

/// Findings when no process was found: other cranes, domains or interfaces that have processes.
[[nodiscard]] Findings judge_silence(const ExpectedCrane& expected, const Observed& observed,
                                     const std::vector<LocalProcess>& local,
                                     const std::vector<Announced>& announced);
/// Checks for processes of the loop that are missing, starting or late, and for clocks that differ.
[[nodiscard]] Findings judge_processes_on_bus(const Observed& observed);
/// Checks for incompatible writers and programs.
[[nodiscard]] Findings judge_mismatches(const Observed& observed);
/// Checks the number of participants, because a domain has a limited number of ports on each computer.
[[nodiscard]] Findings judge_number_of_participants(const std::vector<LocalProcess>& local,
                                                    std::uint32_t domain);

}  // namespace crane::doctor
