/// crane hw jog, calibrate, selftest: small supervised motions.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands/hw.hpp"
#include "cli/commands/hw_commands.hpp"
#include "cli/number_range.hpp"
#include "cli/text_table.hpp"
#include "crane/bring_up/calibration.hpp"
#include "crane/bring_up/jog.hpp"
#include "crane/bring_up/selftest.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::cli {
namespace {

using bring_up::coordinate_name;
using bring_up::coordinate_unit;

struct HwMoveOptions {
  BoardOptions board;
  std::string axis;
  double drive_v = 0, distance = 0.05, largest_v = 4;
  std::string answers, out = "calibrated.toml";
  bool json = false;
};
void say(const std::string& text) { std::cerr << text << '\n'; }

std::size_t axis_named(const std::string& name) {
  std::size_t axis = 0;
  while (coordinate_name(axis) != name) ++axis;  // CLI11 has checked the name
  return axis;
}

int jog(const HwMoveOptions& options) {
  runtime::install_stop_signals();
  OpenBoard opened{options.board};
  bring_up::JogPlan plan{.axis = axis_named(options.axis),
                         .drive_v = options.drive_v,
                         .distance = options.distance,
                         .duration_s = 2,
                         .duration_without_motion_s = 0.3};
  plan.release[plan.axis] = true;
  if (const auto problems = bring_up::problems(plan, opened.rig()); !problems.empty())
    throw configuration::ConfigurationError(problems);
  bring_up::Session session{opened.rig(), opened.board(), opened.clock()};
  const auto jog = bring_up::run(session, plan);
  session.make_safe();
  TextTable table{{"coordinate", "moved", "unit", "counts"}};
  for (std::size_t i = 0; i < bridge::kCounters; ++i)
    if (opened.rig().measures(i))
      table.add({std::string{coordinate_name(i)}, fixed(jog.moved[i], 4), std::string{coordinate_unit(i)},
                 std::to_string(jog.record.back().counts[i] - jog.record.front().counts[i])});
  table.print(std::cout);
  if (!jog.opened[plan.axis]) throw std::runtime_error("the brake of " + options.axis + " did not open");
  if (jog.limit) std::cerr << "ended at a limit switch\n";
  return runtime::kExitDone;
}

int selftest(const HwMoveOptions& options) {
  runtime::install_stop_signals();
  OpenBoard opened{options.board};
  bring_up::Session session{opened.rig(), opened.board(), opened.clock()};
  const auto evidence = bring_up::gather(
      session, {.largest_v = options.largest_v, .progress = options.json ? [](auto&) {} : say});
  session.make_safe();
  const auto findings = bring_up::judge(opened.rig(), evidence);
  if (options.json) {
    nlohmann::ordered_json found{{"rig", opened.rig().name},
                                 {"board", opened.board().name()},
                                 {"findings", nlohmann::ordered_json::array()}};
    for (const auto& finding : findings)
      found["findings"].push_back({{"fault", bring_up::name_of(finding.fault)},
                                   {"subject", finding.subject},
                                   {"text", finding.text}});
    std::cout << found.dump(2) << '\n';
  } else {
    for (const auto& finding : findings)
      std::cout << bring_up::name_of(finding.fault) << ": " << finding.text << '\n';
    if (findings.empty()) std::cout << opened.rig().name << ": the wiring agrees with the rig file\n";
  }
  return findings.empty() ? runtime::kExitDone : runtime::kExitFailed;
}

/// Reads one line of `in` per question.
std::string answered(std::istream& in, const std::string& question, bool echo) {
  std::cout << question << ' ' << std::flush;
  std::string answer;
  if (!std::getline(in, answer)) throw bring_up::Ended("no answer; no file was written; 0 V, brakes closed");
  if (echo) std::cout << answer << '\n';
  return answer;
}

/// Call this function before any motion.
void require_writable(const std::filesystem::path& file) {
  const auto target = std::filesystem::exists(file) ? file : std::filesystem::absolute(file).parent_path();
  if (::access(target.c_str(), W_OK) != 0)
    throw configuration::ConfigurationError(
        {file.string() + ": cannot be written: " + std::strerror(errno) + "; choose another --out"});
}

int calibrate(const HwMoveOptions& options) {
  runtime::install_stop_signals();
  std::ifstream answers;
  if (!options.answers.empty()) answers.open(options.answers);
  OpenBoard opened{options.board};
  bring_up::require_own_file(opened.rig(), options.out);
  auto inputs = configuration::with_base_files({opened.rig().path});
  if (!options.answers.empty()) inputs.emplace_back(options.answers);
  configuration::require_other({options.out}, inputs);
  require_writable(options.out);
  bring_up::Session session{opened.rig(), opened.board(), opened.clock()};
  const auto found =
      bring_up::calibrate(session, {.largest_v = options.largest_v,
                                    .ask =
                                        [&](const std::string& question) {
                                          return answered(options.answers.empty() ? std::cin : answers,
                                                          question, !options.answers.empty());
                                        },
                                    .say = say});
  files::write_file(options.out, bring_up::calibration_file(opened.rig(), found, options.out));
  std::cout << options.out << ": written; next: crane hw selftest --rig " << options.out << '\n';
  return runtime::kExitDone;
}

/// Adds a command with its options, which live as long as the command.
struct Added {
  CLI::App& command;
  HwMoveOptions& options;
};

Added add(CLI::App& hw, Action& chosen, int (*action)(const HwMoveOptions&), const char* name,
          const char* summary) {
  auto options = std::make_shared<HwMoveOptions>();
  auto* command = hw.add_subcommand(name, summary);
  add_board_options(*command, options->board);
  command->callback([options, action, &chosen] { chosen = [options, action] { return action(*options); }; });
  return {*command, *options};
}

void add_largest_volts(CLI::App& command, HwMoveOptions& options) {
  command
      .add_option("--volts", options.largest_v,
                  "largest voltage; the voltage increases from 1 V until the axis moves")
      ->check(number_in(1.0, bring_up::kLargestJog_v))
      ->capture_default_str();
}

}  // namespace

void add_hw_jog(CLI::App& hw, Action& chosen) {
  const auto [command, options] = add(hw, chosen, jog, "jog", "Make one small motion of one drive");
  command.add_option("--axis", options.axis, "trolley, slew or hoist")
      ->required()
      ->check(CLI::IsMember(plant::drive_names()));
  command
      .add_option("--volts", options.drive_v,
                  "voltage in V, -5 to 5; with correct signs, a positive voltage moves the axis outward")
      ->required();
  command
      .add_option("--distance", options.distance,
                  "distance in m or rad after which the voltage ends, up to 0.5; the axis then brakes")
      ->capture_default_str();
  command.footer(
      "The motion ends after 2 s, at a limit switch, at the emergency stop, or after 0.3 s when no counter\n"
      "changes.\n"
      "Example: crane hw jog --rig emulated_servo_to_go --axis trolley --volts 2");
}

void add_hw_selftest(CLI::App& hw, Action& chosen) {
  const auto [command, options] =
      add(hw, chosen, selftest, "selftest", "Move each drive a little and report wiring faults");
  add_largest_volts(command, options);
  command.add_flag("--json", options.json, "one JSON object");
  command.footer(
      "Required: the crane is at [start] of the rig file, the load hangs at rest, and each axis has 10 cm\n"
      "(0.2 rad) of free travel.\n"
      "The command prints one line per fault. Exit code 1: at least one fault.\n"
      "Example: crane hw selftest --rig emulated_servo_to_go\n"
      "         crane hw selftest --rig emulated_servo_to_go --wired-as swapped.toml     (docs/hardware.md)");
}

void add_hw_calibrate(CLI::App& hw, Action& chosen) {
  const auto [command, options] = add(hw, chosen, calibrate, "calibrate",
                                      "Determine signs, scales and position of the crane, step by step");
  add_largest_volts(command, options);
  command.add_option("--out", options.out, "rig file to write; it extends the file of --rig")
      ->capture_default_str();
  command.add_option("--answers", options.answers, "file with one answer per line; default: the terminal")
      ->check(CLI::ExistingFile);
  command.footer(
      "Each axis moves by 10 cm (0.3 rad). The command then asks for direction, distance and present\n"
      "position. An empty answer to the last two questions keeps the value of the rig file. The load must\n"
      "hang at rest at the start.\n"
      "Example: crane hw calibrate --rig my_crane.toml --out my_crane_calibrated.toml");
}

}  // namespace crane::cli
