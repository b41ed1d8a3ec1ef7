/// crane diagnose: finds errors of the simulation of a rig from measured data.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "cli/commands/commands.hpp"
#include "cli/diagnosis_data.hpp"
#include "cli/text_table.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/diagnosis/report.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

namespace fs = std::filesystem;
using diagnosis::Diagnosis;

struct DiagnoseOptions {
  std::string rig = stack::kDefaultRig, mapping, out = "out/diagnose";
  std::vector<std::string> train, test;
  std::optional<double> from_s, to_s;
  std::uint64_t seed = 1;
  std::size_t effects = 3;
  diagnosis::Accuracy accuracy = diagnosis::kUsualAccuracy;
  bool json = false, no_picture = false, check = false, progress = false;
};

/// Shows the progress in one line of the terminal.
void show_share(double share, const std::string& what) {
  constexpr std::size_t kBar = 30, kText = 48;
  const auto filled = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * kBar);
  std::string text = what.substr(0, kText);
  text.resize(kText, ' ');
  std::cerr << "\r[" << std::string(filled, '#') << std::string(kBar - filled, ' ') << "] "
            << static_cast<int>(100 * share) << " % " << text << (share >= 1 ? "\n" : "") << std::flush;
}

/// Progress for a parent program: "progress 0.25 TEXT".
void tell_share(double share, const std::string& what) {
  std::cerr << "progress " << std::clamp(share, 0.0, 1.0) << ' ' << what << std::endl;
}

/// Output of the progress.
std::function<void(double, const std::string&)> progress_of(const DiagnoseOptions& options) {
  if (options.progress) return tell_share;
  if (::isatty(STDERR_FILENO) == 1) return show_share;
  return [](double, const std::string&) {};
}

std::string rounded(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

std::string values_of(const std::vector<diagnosis::Estimate>& estimates) {
  std::string text;
  for (const auto& e : estimates)
    text +=
        (text.empty() ? "" : ", ") + e.name + " " + rounded(e.value) + (e.unit == "1" ? "" : " " + e.unit);
  return text;
}

void print_diagnosis(const Diagnosis& diagnosis, const DiagnoseOptions& options) {
  std::cout << name_of(diagnosis.verdict) << ": " << diagnosis.sentence << '\n';
  if (!diagnosis.causes.empty()) {
    TextTable table{{"cause", "axis", "parameter", "value", "+-", "unit"}};
    for (const auto& cause : diagnosis.causes)
      for (const auto& e : cause.parameters)
        table.add({cause.name, cause.axis, e.name, rounded(e.value), rounded(e.std_dev), e.unit});
    table.print(std::cout);
  }
  for (const auto& inaccuracy : diagnosis.within_accuracy)
    std::cout << "significant, but within the accuracy of the rig file: " << inaccuracy.name
              << (inaccuracy.axis.empty() ? "" : " (" + inaccuracy.axis + ")") << ", "
              << values_of(inaccuracy.parameters) << '\n';
  for (const auto& quantity : diagnosis.calibrated)
    for (const auto& p : quantity.parameters)
      std::cout << "calibrated within the accuracy of the rig file: " << quantity.name
                << (quantity.axis.empty() ? "" : " (" + quantity.axis + ")") << ", " << p.name << ' '
                << rounded(p.value) << (p.unit == "1" ? "" : " " + p.unit) << '\n';
  for (const auto& cause : diagnosis.attempted)
    std::cout << "tried: " << cause.name << (cause.axis.empty() ? "" : " (" + cause.axis + ")")
              << " is part of the best explanation and is not proven as a cause\n";
  const auto& held_out = diagnosis.held_out;
  if (!diagnosis.extension.empty() && diagnosis.verdict != diagnosis::Verdict::unknown)
    std::cout << (diagnosis.causes.empty()
                      ? "held-out gain of the calibration (within the accuracy of the rig file) "
                      : "held-out gain ")
              << rounded(held_out.gain) << " [" << rounded(held_out.gain_ci95[0]) << ", "
              << rounded(held_out.gain_ci95[1]) << "] (95 %)\n";
  if (diagnosis.next_experiment)
    std::cout << "next experiment: " << diagnosis.next_experiment->description << "\n  crane run "
              << (fs::path{options.out} / "next_experiment.toml").string() << " --rig " << options.rig
              << '\n';
  for (const std::string& note : diagnosis.notes) std::cout << "note: " << note << '\n';
  std::cout << "seed " << options.seed << ", " << rounded(diagnosis.runtime_s) << " s; "
            << (fs::path{options.out} / "report.html").string() << '\n';
}

void print_check(const diagnosis::Check& check, const DiagnosisData& data) {
  TextTable table{{"candidate", "smallest detectable size", "hardly distinguishable from"}};
  for (const auto& visibility : check.excitation) {
    std::string alike;
    for (const auto& other : visibility.alike)
      alike += (alike.empty() ? "" : ", ") + other.label + " (" + rounded(other.cosine) + ")";
    table.add({visibility.label, visibility.visible ? values_of(visibility.least) : "not detectable", alike});
  }
  table.print(std::cout);
  for (const auto& proposal : check.next)
    std::cout << (proposal.from.empty() ? "record next, to detect " : "record next, to distinguish ")
              << proposal.of << (proposal.from.empty() ? "" : " from " + proposal.from) << ": "
              << proposal.motion.description << '\n';
  for (const std::string& note : data.notes) std::cout << "note: " << note << '\n';
}

diagnosis::Request request_of(const DiagnoseOptions& options) {
  diagnosis::Request request;
  request.seed = options.seed;
  request.most_effects = options.effects;
  request.accuracy = options.accuracy;
  request.progress = progress_of(options);
  return request;
}

int check_data(const DiagnoseOptions& options, const configuration::Rig& rig, DiagnosisData data) {
  const diagnosis::Request request = request_of(options);
  const diagnosis::Check check = diagnosis::check(rig, std::move(data.train), request);
  if (options.json)
    std::cout << diagnosis::to_json(check).dump(2) << '\n';
  else
    print_check(check, data);
  return runtime::kExitDone;
}

/// @throws configuration::ConfigurationError when a file of the report is one of the inputs
void require_other_files(const DiagnoseOptions& options, const configuration::Rig& rig) {
  auto inputs = configuration::with_base_files({rig.path});
  for (const auto* files : {&options.train, &options.test})
    inputs.insert(inputs.end(), files->begin(), files->end());
  if (!options.mapping.empty()) inputs.emplace_back(options.mapping);
  std::vector<fs::path> outputs;
  for (const char* name : diagnosis::kReportFiles) outputs.push_back(fs::path{options.out} / name);
  configuration::require_other(outputs, inputs);
}

int diagnose_data(const DiagnoseOptions& options) {
  if (options.test.empty() && !options.check)
    throw diagnosis::DataError({"--test: held-out runs are required, except with --check"});
  const auto rig = configuration::load_rig(stack::find_rig(options.rig));
  if (!options.check) require_other_files(options, rig);
  diagnosis::Mapping mapping;
  if (!options.mapping.empty()) mapping = diagnosis::load_mapping(options.mapping);
  if (options.from_s) mapping.whole.from_s = *options.from_s;
  if (options.to_s) mapping.whole.to_s = *options.to_s;
  DiagnosisData data = read_diagnosis_data(options.train, options.test, mapping, rig);
  if (options.check) return check_data(options, rig, std::move(data));
  fs::create_directories(options.out);  // an error is reported before the long computation
  const diagnosis::Request request = request_of(options);
  Diagnosis result = diagnosis::diagnose(rig, data.train, data.test, request);
  result.notes.insert(result.notes.begin(), data.notes.begin(), data.notes.end());
  diagnosis::write_report(options.out, result, rig, data.test);
  if (!options.no_picture) diagnosis::draw_diagnosis(options.out, result, rig, data.test);
  if (options.json)
    std::cout << diagnosis::to_json(result).dump(2) << '\n';
  else
    print_diagnosis(result, options);
  return runtime::kExitDone;
}

int diagnose(const DiagnoseOptions& options) {
  try {
    return diagnose_data(options);
  } catch (const diagnosis::DataError& error) {
    std::cerr << error.what() << '\n';
    return runtime::kExitBadInput;
  }
}

void add_accuracy(CLI::App& command, diagnosis::Accuracy& accuracy) {
  command
      .add_option(
          "--accuracy", accuracy.values,
          "accuracy of gains, lengths, masses and scales in the rig file, as a share of the value; the "
          "report lists smaller errors, which do not change the verdict")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--friction-accuracy", accuracy.friction,
                  "relative accuracy of the Coulomb and viscous friction of the drives")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--time-accuracy", accuracy.times_periods,
                  "accuracy of delays and lags, in control periods")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
}

}  // namespace

void add_diagnose(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<DiagnoseOptions>();
  auto* command = app.add_subcommand(
      "diagnose", "Find the causes of differences between measured data and the simulation");
  command->add_option("--rig", options->rig, "rig file or name of the simulation")->capture_default_str();
  command->add_option("--train", options->train, "measured runs to fit: CSV or MCAP (repeatable)")
      ->required();
  command->add_option(
      "--test", options->test,
      "other measured runs, which only confirm the result (held out): CSV or MCAP (repeatable)");
  command
      ->add_option("--mapping", options->mapping,
                   "file that describes the columns of another laboratory's CSV files")
      ->check(CLI::ExistingFile);
  command->add_option("--from", options->from_s, "ignore rows before this time, in s; applies to all files");
  command->add_option("--to", options->to_s, "ignore rows after this time, in s; applies to all files");
  command
      ->add_option("--out", options->out,
                   "directory for report.html, report.json, extended.toml and pictures")
      ->capture_default_str();
  command
      ->add_option("--effects", options->effects,
                   "largest number of simultaneous causes to search for; a smaller number takes less time")
      ->check(CLI::Range(1, 3))
      ->capture_default_str();
  add_accuracy(*command, options->accuracy);
  command->add_option("--seed", options->seed, "seed of the random resampling")->capture_default_str();
  command->add_flag("--check", options->check,
                    "give no verdict; report the smallest detectable size of each candidate, and the motion "
                    "to record next");
  command->add_flag("--json", options->json, "print report.json");
  command->add_flag("--progress", options->progress, "print lines \"progress SHARE TEXT\" on standard error");
  command->add_flag("--no-picture", options->no_picture, "do not draw SVG files");
  command->footer(
      "Example: crane diagnose --rig virginia_tech_tower --train a.csv b.mcap --test c.csv --out "
      "out/diagnose\n"
      "         crane run maneuver_1 --rig out/diagnose/extended.toml\n"
      "Verdicts:\n"
      "  none        these data show no error of the simulation beyond the accuracy of the rig file\n"
      "  named       the simulation lacks these causes\n"
      "  parameter   a value of the rig file is wrong\n"
      "  ambiguous   several causes explain the data equally well; the next experiment distinguishes them\n"
      "  unknown     the simulation is wrong, and no known cause explains it\n"
      "With --effects 1, a diagnosis takes about 30 s per minute of data on two processors, with more\n"
      "simultaneous causes several times as long.\n"
      "Exit code: 0 for every verdict, 1 when a file cannot be written, 2 for bad arguments, files or data.\n"
      "docs/diagnosis.md explains files, verdicts and limits; docs/diagnosis_method.md the method.");
  command->callback([options, &chosen] { chosen = [options] { return diagnose(*options); }; });
}

}  // namespace crane::cli
