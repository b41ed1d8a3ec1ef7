/// crane identify friction: experiment and estimation of the friction of one drive. crane identify tables:
/// the theoretical study of the dissertation, printed and recomputed.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands/commands.hpp"
#include "cli/number_range.hpp"
#include "cli/plant_option.hpp"
#include "cli/text_table.hpp"
#include "crane/identification/study.hpp"
#include "identification/axis_data.hpp"
#include "identification/friction_experiment.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

namespace id = identification;

struct IdentifyOptions {
  identification::FrictionExperimentOptions experiment;
  std::string rig = stack::kDefaultRig, axis, out = "out/identify", from;
  std::string clock = "lockstep";
  stack::Plant plant = stack::Plant::simulated;
  double from_s = 0, to_s = 1e9;
  bool json = false, no_picture = false;
  std::vector<std::string> vendors;
};

std::string with_error(const id::Estimate& estimate) {
  return fixed(estimate.value, 4) + " +- " + fixed(estimate.standard_error, 4);
}

void print_estimates(const identification::FrictionEstimates& estimates,
                     const control::DriveFriction& nominal, double gain) {
  TextTable table{{"over K_m", "b+", "b-", "c+ [V]", "c- [V]", "K_m", "residual [V]"}};
  const auto add = [&table](const char* name, const id::FrictionEstimate& e) {
    table.add({name, with_error(e.viscous_positive), with_error(e.viscous_negative),
               with_error(e.coulomb_positive), with_error(e.coulomb_negative),
               e.gain.standard_error > 0 ? with_error(e.gain) : fixed(e.gain.value, 4) + " given",
               fixed(e.residual_rms_v, 4)});
  };
  add("dissertation", estimates.dissertation);
  add("midpoint", estimates.midpoint);
  if (estimates.midpoint_joint) add("midpoint, K_m too", *estimates.midpoint_joint);
  table.add({"rig file", fixed(nominal.viscous_positive_vspm, 4), fixed(nominal.viscous_negative_vspm, 4),
             fixed(nominal.coulomb_positive_v, 4), fixed(nominal.coulomb_negative_v, 4), fixed(gain, 4)});
  table.print(std::cout);
  if (!estimates.gain_refusal.empty()) std::cout << estimates.gain_refusal << '\n';
}

void print_result(const identification::FrictionExperimentResult& result) {
  const std::string unit = result.axis == plant::kTrolley ? "m" : "rad";
  const auto stiction = [](const id::Stiction& s) {
    return fixed(s.mean_v, 3) + " V, spread " + fixed(s.spread_v, 3) + " V of " + std::to_string(s.count);
  };
  const auto deviation = [&unit](const id::Deviation& d) {
    return "rms " + fixed(1000 * d.rms, 2) + " m" + unit + ", peak " + fixed(1000 * d.peak, 2) + " m" + unit;
  };
  if (result.amplitude_share < 1)
    std::cout << "The multi-sine was reduced to " << fixed(100 * result.amplitude_share, 0)
              << " % of the dissertation's amplitude because of the limits of travel, speed and swing.\n";
  std::cout << "stiction +       " << stiction(result.stiction.positive) << "\nstiction -       "
            << stiction(result.stiction.negative) << "\nsteps of " << fixed(result.step, 3) << ' ' << unit
            << " compared with the linear axis\n  compensated    " << deviation(result.compensated)
            << "\n  uncompensated  " << deviation(result.uncompensated)
            << "\nnew values: " << result.fragment.string() << '\n';
}

/// Estimates the friction from a recorded run of a rig or a simulation, without an experiment.
int estimate_from(const IdentifyOptions& options, const configuration::Rig& rig) {
  const auto& experiment = options.experiment;
  const auto table = recording::read_csv(options.from);
  const auto run = identification::axis_run_from(table, rig, experiment.axis, options.from_s, options.to_s);
  const double gain =
      identification::acting_gain(rig.design, experiment.axis, identification::mean_trolley_position(table));
  const auto estimates =
      identification::estimate_both(run, experiment.zero_band, experiment.cutoff_ratio, gain);
  if (options.json)
    std::cout << identification::to_json(estimates).dump(2) << '\n';
  else
    print_estimates(estimates, rig.design.friction[experiment.axis], gain);
  return runtime::kExitDone;
}

int identify_friction(IdentifyOptions options) {
  runtime::install_stop_signals();
  auto& experiment = options.experiment;
  experiment.rig = stack::find_rig(options.rig);
  experiment.axis = options.axis == "trolley" ? plant::kTrolley : plant::kSlew;
  experiment.directory = options.out;
  experiment.picture = !options.no_picture;
  experiment.realtime = options.clock == "realtime";
  experiment.plant = options.plant;
  const auto rig = configuration::load_rig(experiment.rig);
  if (!options.from.empty()) return estimate_from(options, rig);
  experiment.vendors = stack::vendors_from(options.vendors, stack::stack_with(experiment.plant));
  const auto result = identification::identify_friction(experiment);
  if (!result.difference_from_start.empty()) std::cerr << "warning: " << result.difference_from_start << '\n';
  if (options.json) {
    std::cout << identification::to_json(result).dump(2) << '\n';
    return runtime::kExitDone;
  }
  print_estimates(result.estimates, rig.design.friction[experiment.axis],
                  result.estimates.midpoint.gain.value);
  print_result(result);
  return runtime::kExitDone;
}

int print_tables(bool json) {
  const auto rows = id::recompute_tables();
  if (json) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& row : rows)
      list.push_back({{"table", row.table},
                      {row.variable, row.value},
                      {"exact", exact(row)},
                      {"printed", row.printed},
                      {"recomputed", row.recomputed},
                      {"midpoint", row.midpoint},
                      {"printed_chatters", row.printed_chatters}});
    std::cout << list.dump(2) << '\n';
    return runtime::kExitDone;
  }
  TextTable table{{"table", "row", "", "b+", "b-", "c+", "c-"}};
  const auto add = [&table](const id::StudyRow& row, const char* what, const id::Coefficients& values) {
    table.add({row.table, row.variable + " = " + fixed(row.value, row.variable == "d_s" ? 3 : 1), what,
               fixed(values[0], 4), fixed(values[1], 4), fixed(values[2], 4), fixed(values[3], 4)});
  };
  for (const auto& row : rows) {
    add(row, row.printed_chatters ? "printed *" : "printed", row.printed);
    add(row, "recomputed", row.recomputed);
    add(row, "midpoint", row.midpoint);
  }
  table.print(std::cout);
  std::cout
      << "All values divided by K_m, in volts; exact: 2.8 5.5 1 1.2, without Coulomb friction (3.3) 2.8 5.5 "
         "0 0.\n"
         "*: depends on the chattering of the source's integrator at standstill; cannot be reproduced.\n";
  return runtime::kExitDone;
}

void add_friction(CLI::App& identify, Action& chosen) {
  auto options = std::make_shared<IdentifyOptions>();
  auto& experiment = options->experiment;
  auto* command =
      identify.add_subcommand("friction", "Identify viscous, Coulomb and static friction of one drive");
  command->add_option("--axis", options->axis, "trolley or slew")
      ->required()
      ->check(CLI::IsMember({"trolley", "slew"}));
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  command->add_option("--out", options->out, "directory for runs, estimates, picture and the new rig file")
      ->capture_default_str();
  command->add_option("--seconds", experiment.duration_s, "length of the sum of sines")
      ->check(number_in(20.0, 600.0))
      ->capture_default_str();
  command->add_option("--zero-band", experiment.zero_band, "d_s in m/s or rad/s; slower rows are not used")
      ->check(number_in(0.0, 10.0))
      ->capture_default_str();
  command
      ->add_option("--cut-off", experiment.cutoff_ratio,
                   "cut-off / sampling frequency of the zero-phase filter; 0: no filter")
      ->check(number_in(0.0, 0.49))
      ->capture_default_str();
  command
      ->add_option("--from", options->from,
                   "evaluate this CSV file of a recorded run instead of an experiment")
      ->check(CLI::ExistingFile);
  command->add_option("--begin", options->from_s, "with --from: time_s of the first row used");
  command->add_option("--end", options->to_s, "with --from: time_s of the last row used");
  auto* clock =
      command->add_option("--clock", options->clock, "lockstep, or realtime as on a rig (five minutes)")
          ->check(CLI::IsMember({"lockstep", "realtime"}))
          ->capture_default_str();
  add_plant_option(*command, options->plant, " (real boards in realtime only)");
  command->add_flag("--in-process", experiment.in_process, "all components in this process, without DDS")
      ->excludes(clock);
  command->add_flag("--json", options->json, "print the estimates as JSON");
  command->add_flag("--no-picture", options->no_picture, "draw no picture");
  command->add_option("--dds-for", options->vendors,
                      "NAME=VENDOR: DDS implementation of one process (repeatable)");
  runtime::add_bus_options(*command, experiment.bus);
  command->footer(
      "Example: crane identify friction --axis trolley --out out/trolley\n"
      "         crane run maneuver_1 --rig out/trolley/identified.toml\n"
      "docs/identification.md explains the experiment and its results.");
  command->callback([options, &chosen] { chosen = [options] { return identify_friction(*options); }; });
}

}  // namespace

void add_identify(CLI::App& app, Action& chosen) {
  auto* identify = app.add_subcommand("identify", "Estimate friction and gain of a drive from its motion");
  identify->footer("Example: crane identify friction --axis slew --in-process");
  add_friction(*identify, chosen);
  auto json = std::make_shared<bool>(false);
  auto* tables = identify->add_subcommand("tables", "Recompute Tables 3.1 to 3.5 of the dissertation");
  tables->add_flag("--json", *json, "print as JSON");
  tables->footer("Example: crane identify tables");
  tables->callback([json, &chosen] { chosen = [json] { return print_tables(*json); }; });
}

}  // namespace crane::cli
