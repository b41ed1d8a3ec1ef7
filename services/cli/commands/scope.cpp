/// crane scope: signals before and after the tick in which a condition becomes true, as curves and as CSV.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "cli/curves.hpp"
#include "cli/number_range.hpp"
#include "cli/recording_argument.hpp"
#include "cli/scope_input.hpp"
#include "cli/scope_picture.hpp"
#include "cli/units.hpp"
#include "commands.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/recording/parts.hpp"

namespace crane::cli {
namespace {

using observation::Capture, observation::FieldTable;

constexpr double kLongest_s = 600;

struct ScopeOptions {
  std::string trigger;
  std::vector<std::string> signals;
  double pre_s = 1, post_s = 2, timeout_s = 1e9;
  bool single = false, normal = false, automatic = false;
  std::filesystem::path out, file;
  runtime::BusOptions bus = tool_bus();
  [[nodiscard]] bool repeats() const { return normal || automatic; }
};

/// Wrong trigger or signals. what() states every problem.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Scope {
 public:
  /// @throws BadInput
  Scope(const ScopeOptions& options, const FieldTable& table)
      : options_{options},
        table_{table},
        selection_{table},
        trigger_{prepared()},
        memory_{trigger_.memory()},
        rows_{table, selection_.columns(), [this](const observation::Row& row) { add(row); }},
        acquisition_{{.before_ns = static_cast<std::int64_t>(options.pre_s * 1e9),
                      .after_ns = static_cast<std::int64_t>(options.post_s * 1e9),
                      .automatic = options.automatic}} {
    const bool in_place = options.repeats() && options.file.empty() && output_is_terminal();
    if (!in_place) return;
    screen_.emplace();
    screen_->show("waiting for the trigger " + trigger_.text() + "\nq ends\n");
  }

  [[nodiscard]] observation::TickRows& rows() { return rows_; }
  [[nodiscard]] bool finished() {
    return (!options_.repeats() && captures_ > 0) || (screen_ && screen_->quit_requested());
  }

  /// Call at the end of the data. @return exit code
  int finish() {
    if (!finished()) rows_.finish();
    if (!finished())
      if (const auto capture = acquisition_.finish()) show(*capture);
    screen_.reset();
    if (in_place_) std::cout << last_picture_;
    if (captures_ > 0) return runtime::kExitDone;
    std::cerr << "crane scope: the trigger did not occur in " << acquisition_.rows()
              << " ticks: " << trigger_.text() << '\n';
    for (std::size_t i = 0; i < extents_.size(); ++i)
      if (extents_[i])
        std::cerr << "  " << table_.name_of(selection_.columns()[i]) << " was between " << extents_[i]->low
                  << " and " << extents_[i]->high << ' ' << table_.leaf_of(selection_.columns()[i]).unit
                  << '\n';
    return runtime::kExitFailed;
  }

 private:
  expression::Expression prepared() {
    std::string problems;
    const auto collect = [&problems](const std::string& what) {
      problems += (problems.empty() ? "" : "\n") + what;
    };
    for (const auto& signal : options_.signals) try {
        selection_.add(signal);
      } catch (const std::invalid_argument& error) {
        collect(std::string{"--signal: "} + error.what());
      }
    std::optional<expression::Expression> trigger;
    try {
      trigger.emplace(expression::condition(options_.trigger, selection_.vocabulary()));
    } catch (const expression::Error& error) {
      collect(std::string{"--trigger:\n"} + error.what());
    }
    if (!problems.empty()) throw BadInput(problems);
    return std::move(*trigger);
  }

  void add(const observation::Row& row) {
    if (finished()) return;
    if (acquisition_.rows() == 0 && options_.file.empty() && !screen_)
      std::cerr << "armed at tick " << row.tick << ": waiting for " << trigger_.text() << '\n';
    extents_.resize(row.values.size());
    for (std::size_t i = 0; i < row.values.size(); ++i) {
      if (std::isnan(row.values[i])) continue;
      if (!extents_[i]) extents_[i] = Extent{row.values[i], row.values[i]};
      extents_[i]->low = std::min(extents_[i]->low, row.values[i]);
      extents_[i]->high = std::max(extents_[i]->high, row.values[i]);
    }
    if (const auto capture = acquisition_.add(row, trigger_.evaluate(row.values, memory_))) show(*capture);
  }

  void show(const Capture& capture) {
    ++captures_;
    const auto picture = picture_of(capture, table_, selection_.columns(), trigger_.text(), terminal_size());
    if (screen_) {
      screen_->show(picture);
      in_place_ = true;
      last_picture_ = picture;
    } else {
      std::cout << picture << std::flush;
    }
    if (!options_.out.empty()) write(capture);
  }

  /// FILE.csv; the captures after the first: FILE_2.csv, FILE_3.csv, ...
  void write(const Capture& capture) {
    auto file = options_.out;
    if (captures_ > 1)
      file.replace_filename(file.stem().string() + "_" + std::to_string(captures_) +
                            file.extension().string());
    if (!options_.file.empty()) configuration::require_other({file}, recording::files_of(options_.file));
    recording::write_csv(file, table_of(capture, table_, selection_.columns()));
    if (!screen_) std::cout << "written: " << file.string() << '\n';
  }

  const ScopeOptions& options_;
  const FieldTable& table_;
  observation::FieldSelection selection_;
  expression::Expression trigger_;
  expression::Memory memory_;
  observation::TickRows rows_;
  observation::Acquisition acquisition_;
  std::vector<std::optional<Extent>> extents_;  ///< by column
  std::optional<Screen> screen_;
  bool in_place_ = false;
  std::string last_picture_;
  int captures_ = 0;
};

int from_recording(const ScopeOptions& options) {
  configuration::require_other({options.out}, recording::files_of(options.file));
  recording::McapReader recording{options.file};
  const FieldTable table{recording};
  Scope scope{options, table};
  feed_recording(recording, table, scope.rows(), [&] { return scope.finished(); });
  return scope.finish();
}

int live(const ScopeOptions& options) {
  const FieldTable table;
  Scope scope{options, table};
  auto bus = open_bus(options.bus);
  feed_live(bus, table, scope.rows(), options.timeout_s, [&] { return scope.finished(); });
  return scope.finish();
}

/// @return exit code; that of a wrong argument for wrong names, expressions and files
int scope(const ScopeOptions& options) {
  try {
    return options.file.empty() ? live(options) : from_recording(options);
  } catch (const BadInput& error) {
    std::cerr << error.what() << '\n';
  } catch (const std::invalid_argument& error) {  // no crane/state in the recording
    std::cerr << "crane scope: " << error.what() << '\n';
  } catch (const recording::ReadError& error) {
    std::cerr << "crane scope: " << error.what() << '\n';
  }
  return runtime::kExitBadInput;
}

void add_time(CLI::App& command, const std::string& name, double& target_s, const std::string& help) {
  command
      .add_option_function<std::string>(
          name,
          [&target_s, name](const std::string& text) {
            try {
              target_s = parse_quantity(text, Dimension::time);
            } catch (const UnitError& error) {
              throw CLI::ValidationError(name, error.what());
            }
            if (target_s < 0 || target_s > kLongest_s)
              throw CLI::ValidationError(name, "'" + text + "' must be in [0, 600] s");
          },
          help)
      ->type_name("TIME");
}

constexpr const char* kFooter =
    "Examples: crane scope --trigger 'abs(state.swing_radial_rad) > 5deg' --pre 1s --post 2s\n"
    "          crane scope --trigger 'supervisor.state == STATE_STOP_C1 or state.command_stale' --file "
    "run.mcap\n"
    "          crane scope --trigger 'state.trolley_position_m - reference.axis[0].position > 20mm' \\\n"
    "            --signal demand.total_v[0] --out capture.csv\n"
    "The trigger is the tick at which the condition becomes true. A condition has fields TOPIC.FIELD (crane "
    "topic echo\n"
    "prints them), numbers with units (deg, mm, ms, m/s, ...), enumerators, + - * / < <= > >= == !=, and, "
    "or, not,\n"
    "abs(x), min(x, ...), max(x, ...), rising(condition). Plain numbers are in SI units. Samples of one tick "
    "are\n"
    "compared with each other; fields of topics that are not written every tick keep their newest value.\n"
    "The curves show all signals and the fields of the trigger; the CSV file has them in the units of the "
    "fields.\n"
    "With --normal and --auto, captures after the first are written to FILE_2.csv, ...; q or Ctrl-C ends.\n"
    "Exit code 1: the trigger did not occur.";

}  // namespace

void add_scope(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<ScopeOptions>();
  auto* command = app.add_subcommand(
      "scope", "Plot signals before and after a trigger: the tick in which a condition becomes true");
  command->add_option("--trigger", options->trigger, "condition of topic fields")
      ->required()
      ->type_name("EXPRESSION");
  command
      ->add_option("--signal", options->signals,
                   "field to show in addition to those of the trigger (repeatable)")
      ->type_name("FIELD");
  add_time(*command, "--pre", options->pre_s, "time shown before the trigger; default 1s");
  add_time(*command, "--post", options->post_s, "time shown after the trigger; default 2s");
  auto* single = command->add_flag("--single", options->single, "end after the first capture (default)");
  auto* normal = command->add_flag("--normal", options->normal, "capture at every trigger");
  auto* automatic = command->add_flag(
      "--auto", options->automatic, "as --normal; also capture when no trigger has occurred for PRE + POST");
  single->excludes(normal)->excludes(automatic);
  normal->excludes(automatic);
  command->add_option("--out", options->out, "CSV file to write")->type_name("FILE");
  command->add_option("--file", options->file, "recording (.mcap) instead of the running crane")
      ->check(existing_recording())
      ->type_name("FILE");
  command->add_option("--timeout", options->timeout_s, "longest wait for the trigger in s")
      ->check(positive_number());
  runtime::add_bus_options(*command, options->bus);
  command->footer(kFooter);
  command->callback([options, &chosen] { chosen = [options] { return scope(*options); }; });
}

}  // namespace crane::cli
