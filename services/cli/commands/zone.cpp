/// crane zone: no-go zones of a rig file.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/number_range.hpp"
#include "cli/output_file.hpp"
#include "cli/recorded_box.hpp"
#include "cli/recording_argument.hpp"
#include "cli/text_table.hpp"
#include "commands.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/configuration/zone_editor.hpp"
#include "crane/fields/printable.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/files/directory_lock.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/recording/run_table.hpp"
#include "crane/runtime/process.hpp"
#include "stack/data_files.hpp"
#include "zone_path.hpp"

namespace crane::cli {
namespace {

struct ZoneOptions {
  std::string name, recording, out;
  std::string rig = "virginia_tech_tower";
  std::optional<double> bottom_m, top_m;
  double from_s = 0, until_s = std::numeric_limits<double>::infinity();
  bool json = false, force = false;
};

bool is_box(const control::Zone& zone) { return zone.shape == control::ZoneShape::box; }

nlohmann::json json_of(const control::Zone& zone) {
  nlohmann::json json{{"name", zone.name},
                      {"shape", is_box(zone) ? "box" : "cylinder"},
                      {"position_x_m", zone.position_x_m},
                      {"position_y_m", zone.position_y_m},
                      {"bottom_m", zone.bottom_m},
                      {"top_m", zone.top_m}};
  if (is_box(zone))
    json["size_x_m"] = zone.size_x_m, json["size_y_m"] = zone.size_y_m;
  else
    json["radius_m"] = zone.radius_m;
  return json;
}

void print(const std::vector<control::Zone>& zones) {
  TextTable table{{"zone", "shape", "x [m]", "y [m]", "size [m]", "height [m]"}};
  for (const auto& zone : zones)
    table.add({fields::printable(zone.name), is_box(zone) ? "box" : "cylinder", fixed(zone.position_x_m, 3),
               fixed(zone.position_y_m, 3),
               is_box(zone) ? fixed(zone.size_x_m, 3) + " x " + fixed(zone.size_y_m, 3)
                            : "radius " + fixed(zone.radius_m, 3),
               fixed(zone.bottom_m, 3) + " to " + fixed(zone.top_m, 3)});
  table.print(std::cout);
}

int list(const ZoneOptions& options) {
  const auto rig = configuration::load_rig(stack::find_rig(options.rig));
  if (options.json) {
    auto all = nlohmann::json::array();
    for (const auto& zone : rig.zones) all.push_back(json_of(zone));
    std::cout << all.dump(2) << '\n';
  } else if (rig.zones.empty()) {
    std::cout << rig.name << ": no zones\n";
  } else {
    print(rig.zones);
  }
  return runtime::kExitDone;
}

/// Call before anything is read: an output of another name must not be the recording or a base of the rig
/// file.
void require_other_files(const ZoneOptions& options, const std::filesystem::path& rig) {
  auto inputs = configuration::with_base_files({rig});
  inputs.erase(inputs.begin());  // the rig file itself is replaced
  if (!options.recording.empty()) inputs.emplace_back(options.recording);
  configuration::require_other({options.out.empty() ? rig : std::filesystem::path{options.out}}, inputs);
}

/// Replaces the rig file, or the file of --out, by its changed text.
template <class Change>
void rewrite(const ZoneOptions& options, const std::filesystem::path& rig, Change change) {
  const std::filesystem::path target = options.out.empty() ? rig : std::filesystem::path{options.out};
  if (!options.out.empty()) require_new(target, options.force);
  const files::DirectoryLock lock{std::filesystem::weakly_canonical(target).parent_path()};
  const auto text = change(configuration::file_text(rig), rig.string());
  files::write_file(target, configuration::moved(text, rig, target));
  std::cout << target.string() << ": written; it takes effect when the stack starts again\n";
}

/// Longest time without a position. Between two positions, the hook may have gone around the obstacle outside
/// the box of all recorded positions; at 1 m/s, it returns within this time from at most 0.1 m.
constexpr double kLongestGap_s = 0.2;

/// @throws std::runtime_error when the recording is damaged or lacks positions: the box would be too small
RecordedBox box_of(const ZoneOptions& options, const configuration::Rig& rig) {
  recording::McapReader reader{options.recording};
  const auto version = recording::messages_version(reader);
  const auto difference = recording::version_difference(version);
  if (version && !difference.empty()) throw std::runtime_error(options.recording + ": " + difference);
  RecordedBox box{rig.clearance.suspension_height_m,
                  rig.measures(plant::kHoist) ? 0 : rig.start.position[plant::kHoist]};
  std::optional<std::int64_t> first_ns;
  std::optional<double> last_s;
  reader.for_each({.topics = {std::string{topics::state.description.name}}},
                  [&](const recording::Message& message) {
                    msg::State state{};
                    if (message.data.size() < bus::kEncapsulation_bytes ||
                        !bus::CdrCodec::of(*topics::state.description.descriptor)
                             .decode(message.data.subspan(bus::kEncapsulation_bytes), false, &state))
                      return true;
                    const auto time_ns = state.header.sample_time_ns;
                    if (!first_ns) first_ns = time_ns;
                    const double time_s = static_cast<double>(time_ns - *first_ns) / 1e9;
                    if (time_s < options.from_s || time_s > options.until_s) return true;
                    if (last_s && time_s - *last_s > kLongestGap_s)
                      throw std::runtime_error(options.recording + ": no position of the hook between " +
                                               fixed(*last_s, 2) + " s and " + fixed(time_s, 2) +
                                               " s: the zone could be too small; record the drive again, or "
                                               "choose another part with --from and --to");
                    last_s = time_s;
                    box.add(state);
                    return true;
                  });
  if (!reader.problems().empty())
    throw std::runtime_error(
        options.recording + ": " + reader.problems().front() +
        ": the zone could be too small; record the drive again, or cut the undamaged part "
        "with `crane log cut`");
  if (box.samples() == 0)
    throw std::runtime_error(options.recording + ": no crane/state with known positions in this time");
  return box;
}

int learn(const ZoneOptions& options) {
  const auto path = stack::find_rig(options.rig);
  const auto rig = configuration::load_rig(path);
  require_other_files(options, path);
  const auto box = box_of(options, rig);
  auto zone = box.zone(options.name);
  if (options.bottom_m) zone.bottom_m = *options.bottom_m;
  if (options.top_m) zone.top_m = *options.top_m;
  if (rig.kind == configuration::RigKind::gantry)
    zone.size_y_m = std::max(zone.size_y_m, 2 * rig.clearance.load_radius_m);
  constexpr double kSmallest_m = 0.001;
  if (zone.size_x_m < kSmallest_m || zone.size_y_m < kSmallest_m)
    throw std::runtime_error("the recorded positions of the hook enclose no area (" +
                             fixed(zone.size_x_m, 3) + " x " + fixed(zone.size_y_m, 3) +
                             " m): drive the hook around the obstacle");
  if (zone.top_m - zone.bottom_m < kSmallest_m)
    throw std::runtime_error(
        "the height of the hook did not change: state the height of the obstacle with --top (and --bottom)");
  rewrite(options, path, [&zone](const std::string& text, const std::string& file) {
    return configuration::with_zone(text, file, zone);
  });
  std::cout << box.samples() << " positions of the hook"
            << (box.skipped() > 0 ? ", " + std::to_string(box.skipped()) + " skipped" : "") << ":\n";
  print({zone});
  return runtime::kExitDone;
}

int remove(const ZoneOptions& options) {
  const auto path = stack::find_rig(options.rig);
  require_other_files(options, path);
  rewrite(options, path, [&options](const std::string& text, const std::string& file) {
    return configuration::without_zone(text, file, options.name);
  });
  return runtime::kExitDone;
}

using Options = std::shared_ptr<ZoneOptions>;

CLI::App* add_command(CLI::App& group, const char* name, const char* summary, const Options& options) {
  auto* command = group.add_subcommand(name, summary);
  command->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  return command;
}

void add_output(CLI::App& command, const Options& options) {
  command.add_option("--out", options->out, "write this file instead of the rig file");
  command.add_flag("--force", options->force, "replace an existing file of --out");
}

CLI::Validator a_height() {
  constexpr double kLargest_m = 1e3;
  return number_in(-kLargest_m, kLargest_m);
}

void add_learn(CLI::App& group, const Options& options, Action& chosen) {
  auto* command =
      add_command(group, "learn", "Add a box around all positions of the hook in a recording", options);
  command->add_option("NAME", options->name, "name of the zone")->required();
  command->add_option("RECORDING", options->recording, "recording (MCAP) of a drive around the obstacle")
      ->required()
      ->check(existing_recording());
  command
      ->add_option("--bottom", options->bottom_m,
                   "height of the lower end in m; default: the lowest position of the hook")
      ->check(a_height());
  command
      ->add_option("--top", options->top_m,
                   "height of the upper end in m; default: the highest position of the hook")
      ->check(a_height());
  command->add_option("--from", options->from_s, "use the recording from this time on, in s")
      ->check(not_negative_number());
  command->add_option("--to", options->until_s, "use the recording up to this time, in s")
      ->check(positive_number());
  add_output(*command, options);
  command->footer(
      "Example: crane record drive.mcap --duration 60, drive the hook around the obstacle with crane jog, "
      "then\n"
      "crane zone learn silo drive.mcap --rig my_tower.toml --top 1.5\n"
      "Heights are above the ground of [clearance] suspension_height_m. Comments and all other text of the "
      "file do not change.");
  command->callback([options, &chosen] { chosen = [options] { return learn(*options); }; });
}

}  // namespace

void add_zone(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<ZoneOptions>();
  auto* group = app.add_subcommand(
      "zone", "List, learn and remove no-go zones of a rig file, and find paths around them");
  group->require_subcommand(1);
  group->footer(
      "The supervisor keeps load, hook and cable out of the zones; docs/zones.md describes the method and "
      "its limits.");
  auto* listing = add_command(*group, "list", "List the zones", options);
  listing->add_flag("--json", options->json, "print a JSON array");
  listing->callback([options, &chosen] { chosen = [options] { return list(*options); }; });
  add_zone_path(*group, chosen);
  add_learn(*group, options, chosen);
  auto* removal = add_command(*group, "remove", "Remove a zone from the file", options);
  removal->add_option("NAME", options->name, "name of the zone")->required();
  add_output(*removal, options);
  removal->callback([options, &chosen] { chosen = [options] { return remove(*options); }; });
}

}  // namespace crane::cli
