/// crane zone way: the way of a move around the no-go zones of a rig file.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <numbers>

#include "cli/text_table.hpp"
#include "cli/units.hpp"
#include "commands.hpp"
#include "crane/configuration/way_space.hpp"
#include "crane/control/route.hpp"
#include "crane/fields/printable.hpp"
#include "stack/data_files.hpp"
#include "zone_way.hpp"

namespace crane::cli {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

struct WayOptions {
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

void print_legs(const control::WaySpace& space, const plant::PerAxis& from, const control::Way& way) {
  TextTable table{{"leg", "trolley [m]", "slew [deg]", "cable [m]", "speed share", "clearance [m]"}};
  const auto row = [&](const std::string& name, const plant::PerAxis& at, const std::string& share) {
    table.add({name, fixed(at[0], 3), fixed(at[1] * kDegrees, 1), fixed(at[2], 3), share,
               fixed(control::closest_zone(space, at).clearance_m, 3)});
  };
  row("start", from, "");
  for (std::size_t i = 0; i < way.points.size(); ++i)
    row(std::to_string(i + 1), way.points[i].position, fixed(way.points[i].speed_share, 2));
  table.print(std::cout);
  const control::Route route{space, from, way.points, {.blends = true, .overlaps = true}};
  std::cout << "reference: " << fixed(route.duration_s(), 2) << " s without shaping\n";
}

int show_way(const WayOptions& options) {
  const auto rig = configuration::load_rig(stack::find_rig(options.rig));
  const auto space = configuration::way_space_of(rig);
  plant::PerAxis from = rig.start.position, to{};
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    from[i] = options.from[i].value_or(from[i]);
    to[i] = options.to[i].value_or(from[i]);
  }
  from = control::completed(space, from), to = control::completed(space, to);
  const auto way = control::way_to(space, from, to);
  switch (way.outcome) {
    case control::WayOutcome::straight:
      std::cout << "the straight move is free, at full speed\n";
      return runtime::kExitDone;
    case control::WayOutcome::around:
      print_legs(space, from, way);
      return runtime::kExitDone;
    case control::WayOutcome::target_inside:
      std::cout << "the target is inside a zone:";
      break;
    case control::WayOutcome::no_way:
      std::cout << "no way leads to the target; the zones that bound the reachable space:";
  }
  for (const std::size_t zone : way.blocking) std::cout << ' ' << fields::printable(space.zones[zone].name);
  std::cout << '\n';
  return runtime::kExitFailed;
}

}  // namespace

void add_zone_way(CLI::App& group, Action& chosen) {
  auto options = std::make_shared<WayOptions>();
  auto* command = group.add_subcommand("way", "Print the way of a move around the zones, without a crane");
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  add_axis(*command, "--trolley", Dimension::length, options->to[0], "target of the trolley: 1.05, 105cm");
  add_axis(*command, "--slew", Dimension::angle, options->to[1], "target of the slew axis: 1.57, 90deg");
  add_axis(*command, "--hoist", Dimension::length, options->to[2], "target of the cable length: 0.8, 80cm");
  const std::string from = "start of the move instead of [start]";
  add_axis(*command, "--from-trolley", Dimension::length, options->from[0], from);
  add_axis(*command, "--from-slew", Dimension::angle, options->from[1], from);
  add_axis(*command, "--from-hoist", Dimension::length, options->from[2], from);
  command->footer(
      "Example: crane zone way --rig virginia_tech_tower_silo --from-trolley 0.7 --trolley 0.8 --slew "
      "115deg\n"
      "The supervisor accepts a move if this search finds a way from the measured position.");
  command->callback([options, &chosen] { chosen = [options] { return show_way(*options); }; });
}

}  // namespace crane::cli
