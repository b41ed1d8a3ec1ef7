/// crane doctor: finds why no samples of a crane arrive, and which settings of this computer disturb the
/// control loop.
#include "doctor/doctor.hpp"
#include "cli/number_range.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/tool_bus.hpp"
#include "commands.hpp"

namespace crane::cli {
namespace {

struct DoctorOptions {
  doctor::Options examined;
  std::string rig;
  bool network = false, real_time = false, hardware = false, json = false;
};

void print_json(const doctor::Findings& findings) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& finding : findings)
    list.push_back({{"grade", doctor::name_of(finding.grade)},
                    {"area", finding.area},
                    {"code", finding.code},
                    {"what", finding.what},
                    {"remedy", finding.remedy}});
  std::cout << list.dump(2) << '\n';
}

int examine(DoctorOptions options) {
  runtime::install_stop_signals();
  options.examined.hardware = !options.rig.empty();
  if (!options.rig.empty()) options.examined.rig = options.rig;
  if (options.network || options.real_time || options.hardware) {
    options.examined.network = options.network;
    options.examined.real_time = options.real_time;
    options.examined.hardware = options.hardware;
  }
  const auto findings = doctor::examine(options.examined);
  if (options.json)
    print_json(findings);
  else
    for (const auto& finding : findings) std::cout << doctor::line_of(finding) << '\n';
  const bool healthy =
      std::ranges::find(findings, doctor::Grade::problem, &doctor::Finding::grade) == findings.end();
  return healthy ? runtime::kExitDone : runtime::kExitFailed;
}

}  // namespace

void add_doctor(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<DoctorOptions>();
  options->examined.bus = tool_bus();
  auto* command = app.add_subcommand(
      "doctor", "Find faults of network, real-time settings and board, and print the remedy of each");
  command->add_flag("--net", options->network,
                    "check interfaces, multicast, processes, domain and crane, versions, quality of service");
  command->add_flag("--rt", options->real_time,
                    "check real-time permission, locked memory, receive buffers, lateness of the timer");
  command->add_flag("--hw", options->hardware, "check that the board of the rig file is accessible");
  command->add_flag("--json", options->json, "print the findings as a JSON array");
  command->add_option(
      "--rig", options->rig,
      std::string{"rig file or name: period of the loop, board; default: "} + stack::kDefaultRig);
  command
      ->add_option("--duration", options->examined.duration_s,
                   "duration of listening and of the timer measurement in s")
      ->check(number_in(0.5, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--priority", options->examined.priority,
                   "SCHED_FIFO priority with which the timer is measured")
      ->check(CLI::Range(1, 98))
      ->capture_default_str();
  runtime::add_bus_options(*command, options->examined.bus);
  command->footer(
      "Example: crane doctor --net --interface 192.168.1.5\n"
      "Default: --net --rt; with --rig also --hw. Exit code 1: at least one problem. docs/doctor.md lists\n"
      "the findings.");
  command->callback([options, &chosen] { chosen = [options] { return examine(*options); }; });
}

}  // namespace crane::cli
