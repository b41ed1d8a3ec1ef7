/// crane zone path: the path of a move around the no-go zones of a rig file.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <numbers>

#include "cli/text_table.hpp"
#include "cli/units.hpp"
#include "commands.hpp"
#include "crane/configuration/path_space.hpp"
#include "crane/control/route.hpp"
#include "crane/fields/printable.hpp"
#include "stack/data_files.hpp"
#include "zone_path.hpp"

namespace crane::cli {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

struct PathOptions {
  std::string rig = "virginia_tech_tower";
  std::array<std::optional<double>, plant::kAxes> from, to;
};

void add_axis(CLI::App& command, const std::string& name, Dimension dimension, std::optional<double>& value,
              const std::string& help) {
  command
      .add_option_function<std::string>(
          name,
          [&value, name, dimension](const std::string& text) {
            try {
              value = parse_quantity(text, dimension);
            } catch (const UnitError& error) {
              throw CLI::ValidationError(name, error.what());
            }
          },
          help)
      ->type_name(dimension == Dimension::length ? "LENGTH" : "ANGLE");
}

void print_legs(const control::PathSpace& space, const plant::PerAxis& from, const control::Path& path) {
  TextTable table{{"leg", "trolley [m]", "slew [deg]", "cable [m]", "speed share", "clearance [m]"}};
  const auto row = [&](const std::string& name, const plant::PerAxis& at, const std::string& share) {
    table.add({name, fixed(at[0], 3), fixed(at[1] * kDegrees, 1), fixed(at[2], 3), share,
               fixed(control::closest_zone(space, at).clearance_m, 3)});
  };
  row("start", from, "");
  for (std::size_t i = 0; i < path.points.size(); ++i)
    row(std::to_string(i + 1), path.points[i].position, fixed(path.points[i].speed_share, 2));
  table.print(std::cout);
  const control::Route route{space, from, path.points, {.blends = true, .overlaps = true}};
  std::cout << "reference: " << fixed(route.duration_s(), 2) << " s without shaping\n";
}

/// Checks the targets against the range that the supervisor accepts. @throws
/// configuration::ConfigurationError
void require_in_limits(const PathOptions& options, const configuration::Rig& rig,
                       const control::PathSpace& space) {
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    const auto& axis = space.axis[i];
    for (const auto& [prefix, value] :
         {std::pair{"--", options.to[i]}, std::pair{"--from-", options.from[i]}}) {
      if (!value) continue;
      const std::string given =
          prefix + std::string{plant::kCoordinates[i].name} + " = " + std::to_string(*value);
      if (!axis.present)
        problems.push_back(given + ": the rig " + rig.name + " does not drive this axis");
      else if (!(*value >= axis.low && *value <= axis.high))
        problems.push_back(given + ": must lie in [" + std::to_string(axis.low) + ", " +
                           std::to_string(axis.high) +
                           "] (m or rad), the limits of the rig file less its soft_margin");
    }
  }
  const auto given = [](const auto& value) { return value.has_value(); };
  if (std::ranges::none_of(options.to, given))
    problems.emplace_back("no target: give --trolley, --slew or --hoist");
  if (!problems.empty()) throw configuration::ConfigurationError(problems);
}

int show_path(const PathOptions& options) {
  const auto rig = configuration::load_rig(stack::find_rig(options.rig));
  const auto space = configuration::path_space_of(rig);
  require_in_limits(options, rig, space);
  plant::PerAxis from = rig.start.position, to{};
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    from[i] = options.from[i].value_or(from[i]);
    to[i] = options.to[i].value_or(from[i]);
  }
  from = control::completed(space, from), to = control::completed(space, to);
  const auto path = control::path_to(space, from, to);
  switch (path.outcome) {
    case control::PathOutcome::straight:
      std::cout << "the straight move is free, at full speed\n";
      return runtime::kExitDone;
    case control::PathOutcome::by_waypoints:
      print_legs(space, from, path);
      return runtime::kExitDone;
    case control::PathOutcome::target_inside:
      std::cout << "the target is inside a zone:";
      break;
    case control::PathOutcome::no_path:
      std::cout << "no path leads to the target; the zones that bound the reachable space:";
  }
  for (const std::size_t zone : path.blocking) std::cout << ' ' << fields::printable(space.zones[zone].name);
  std::cout << '\n';
  return runtime::kExitFailed;
}

}  // namespace

void add_zone_path(CLI::App& group, Action& chosen) {
  auto options = std::make_shared<PathOptions>();
  auto* command = group.add_subcommand("path", "Print the path of a move around the zones, without a crane");
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  add_axis(*command, "--trolley", Dimension::length, options->to[0], "target of the trolley: 1.05, 105cm");
  add_axis(*command, "--slew", Dimension::angle, options->to[1], "target of the slew axis: 1.57, 90deg");
  add_axis(*command, "--hoist", Dimension::length, options->to[2], "target of the cable length: 0.8, 80cm");
  const std::string from = "start of the move; default: the position in [start] of the rig file";
  add_axis(*command, "--from-trolley", Dimension::length, options->from[0], from);
  add_axis(*command, "--from-slew", Dimension::angle, options->from[1], from);
  add_axis(*command, "--from-hoist", Dimension::length, options->from[2], from);
  command->footer(
      "Example: crane zone path --rig virginia_tech_tower_silo --from-trolley 0.7 --trolley 0.8 --slew "
      "115deg\n"
      "The supervisor accepts a move if this search finds a path from the measured position.");
  command->callback([options, &chosen] { chosen = [options] { return show_path(*options); }; });
}

}  // namespace crane::cli
