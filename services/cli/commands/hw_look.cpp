/// crane hw list, crane hw probe: show wiring and inputs of a board, without motion.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands/hw.hpp"
#include "cli/commands/hw_commands.hpp"
#include "cli/text_table.hpp"
#include "crane/bridge/homing.hpp"
#include "crane/bridge/measurement.hpp"
#include "crane/bridge/start_counts.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

using bring_up::coordinate_name;
using bring_up::coordinate_unit;
using Json = nlohmann::ordered_json;

struct LookOptions {
  BoardOptions board;
  bool json = false;
};

Json encoders_of(const configuration::Rig& rig) {
  Json found = Json::array();
  for (std::size_t i = 0; i < bridge::kCounters; ++i)
    if (rig.measures(i))
      found.push_back({{"name", coordinate_name(i)},
                       {"counter", rig.encoders[i].channel},
                       {"sign", rig.encoders[i].sign},
                       {"counts_per_unit", rig.encoders[i].counts_per_unit},
                       {"unit", coordinate_unit(i)}});
  return found;
}

Json drives_of(const configuration::Rig& rig) {
  Json found = Json::array();
  for (std::size_t i = 0; i < bridge::kDrives; ++i) {
    if (!rig.drives[i].present) continue;
    const auto& lines = rig.wiring.drives[i];
    found.push_back({{"name", coordinate_name(i)},
                     {"analog_output", rig.drives[i].dac_channel},
                     {"sign", rig.drives[i].sign},
                     {"brake_release_output", lines.brake_release_output},
                     {"brake_closed_input", lines.brake_closed_input},
                     {"limit_low_input", lines.limit_low_input},
                     {"limit_high_input", lines.limit_high_input}});
  }
  return found;
}

Json rig_of(const configuration::Rig& rig) {
  return {{"rig", rig.name},
          {"file", rig.path},
          {"board", rig.board},
          {"encoders", encoders_of(rig)},
          {"drives", drives_of(rig)},
          {"estop_input", rig.wiring.estop_input},
          {"relay_closed_input", rig.wiring.relay_closed_input},
          {"watchdog_output", rig.wiring.watchdog_output}};
}

void print_rig(const Json& rig) {
  std::cout << rig["rig"].get<std::string>() << " (" << rig["file"].get<std::string>()
            << "): board = " << rig["board"].get<std::string>() << '\n';
  TextTable encoders{{"encoder", "counter", "sign", "counts per unit", "unit"}};
  for (const auto& one : rig["encoders"])
    encoders.add({one["name"], one["counter"].dump(), one["sign"].dump(),
                  fixed(one["counts_per_unit"].get<double>(), 3), one["unit"]});
  encoders.print(std::cout);
  TextTable drives{{"drive", "analog output", "sign", "brake output", "brake input", "limit inputs"}};
  for (const auto& one : rig["drives"])
    drives.add({one["name"], one["analog_output"].dump(), one["sign"].dump(),
                one["brake_release_output"].dump(), one["brake_closed_input"].dump(),
                one["limit_low_input"].dump() + ", " + one["limit_high_input"].dump()});
  drives.print(std::cout);
  std::cout << "emergency stop input " << rig["estop_input"] << ", relay input " << rig["relay_closed_input"]
            << ", watchdog output " << rig["watchdog_output"] << '\n';
}

int list(const LookOptions& options) {
  Json found;
  for (const auto& kind : bridge::board_kinds()) found["boards"].push_back(kind.name);
  if (!options.board.rig.empty())
    found["rig"] = rig_of(configuration::load_rig(stack::find_rig(options.board.rig)));
  if (options.json) {
    std::cout << found.dump(2) << '\n';
    return runtime::kExitDone;
  }
  std::cout << "boards:";
  for (const auto& board : found["boards"]) std::cout << ' ' << board.get<std::string>();
  std::cout << '\n';
  if (found.contains("rig")) print_rig(found["rig"]);
  return runtime::kExitDone;
}

Json probed(const configuration::Rig& rig, bridge::Board& board) {
  const auto inputs = board.read();
  const auto start = bridge::start_counts(rig);
  Json found{{"rig", rig.name}, {"board", board.name()}};
  for (std::size_t i = 0; i < bridge::kCounters; ++i)
    if (const auto& encoder = rig.encoders[i]; encoder.counts_per_unit > 0)
      found["counters"].push_back(
          {{"name", coordinate_name(i)},
           {"counter", encoder.channel},
           {"raw_counts", inputs.raw_counts[i]},
           {"coordinate", static_cast<double>(bridge::CountUnwrapper{start[i]}.step(inputs.raw_counts[i])) *
                                  encoder.sign / encoder.counts_per_unit -
                              encoder.rest_angle_rad},
           {"unit", coordinate_unit(i)}});
  for (std::size_t i = 0; i < bridge::kDrives; ++i)
    if (rig.drives[i].present)
      found["drives"].push_back(
          {{"name", coordinate_name(i)},
           {"analog_output", rig.drives[i].dac_channel},
           {"written_v", 0.0},
           {"brake_closed", inputs.brake_closed[i]},
           {"limit_low", inputs.limit_low[i]},
           {"limit_high", inputs.limit_high[i]},
           {"at_mark",
            rig.drives[i].homes() ? Json(bridge::mark_active(rig.drives[i], inputs, i)) : Json(nullptr)}});
  found["estop_pressed"] = inputs.estop_pressed;
  found["relay_dropped"] = inputs.watchdog_dropped;
  return found;
}

std::string yes_or_no(const Json& flag) { return flag.is_null() ? "-" : flag.get<bool>() ? "yes" : "no"; }

int probe(const LookOptions& options) {
  OpenBoard opened{options.board};
  bring_up::Session session{opened.rig(), opened.board(), opened.clock()};
  session.record_braked(0.1);
  const auto found = probed(opened.rig(), opened.board());
  if (options.json) {
    std::cout << found.dump(2) << '\n';
    return runtime::kExitDone;
  }
  std::cout << found["board"].get<std::string>() << '\n';
  TextTable counters{{"encoder", "counter", "raw counts", "coordinate", "unit"}};
  for (const auto& one : found.value("counters", Json::array()))
    counters.add({one["name"], one["counter"].dump(), one["raw_counts"].dump(),
                  fixed(one["coordinate"].get<double>(), 4), one["unit"]});
  counters.print(std::cout);
  TextTable drives{
      {"drive", "analog output", "written", "brake closed", "at low limit", "at high limit", "at mark"}};
  for (const auto& one : found.value("drives", Json::array()))
    drives.add({one["name"], one["analog_output"].dump(), "0 V", yes_or_no(one["brake_closed"]),
                yes_or_no(one["limit_low"]), yes_or_no(one["limit_high"]), yes_or_no(one["at_mark"])});
  drives.print(std::cout);
  std::cout << "emergency stop pressed: " << yes_or_no(found["estop_pressed"])
            << ", watchdog relay open: " << yes_or_no(found["relay_dropped"]) << '\n';
  return runtime::kExitDone;
}

}  // namespace

void add_hw_list(CLI::App& hw, Action& chosen) {
  auto options = std::make_shared<LookOptions>();
  auto* command =
      hw.add_subcommand("list", "List the supported boards, and channels and lines of a rig file");
  command->add_option("--rig", options->board.rig, "rig file or name");
  command->add_flag("--json", options->json, "one JSON object");
  command->footer("Example: crane hw list --rig emulated_servo_to_go");
  command->callback([options, &chosen] { chosen = [options] { return list(*options); }; });
}

void add_hw_probe(CLI::App& hw, Action& chosen) {
  auto options = std::make_shared<LookOptions>();
  auto* command = hw.add_subcommand("probe", "Open the board at 0 V with closed brakes and show its inputs");
  add_board_options(*command, options->board);
  command->add_flag("--json", options->json, "one JSON object");
  command->footer(
      "Counters start at [start] of the rig file. Analog outputs cannot be read back: the column "
      "\"written\"\n"
      "shows the 0 V that the command has set.\n"
      "Example: crane hw probe --rig emulated_servo_to_go");
  command->callback([options, &chosen] { chosen = [options] { return probe(*options); }; });
}

}  // namespace crane::cli
