/// crane-truth: measured data of a crane with hidden causes, for tests and benchmarks of the diagnosis.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "truth/truth.hpp"

namespace {

/// NAME[@AXIS][:AMPLITUDE]
truth::Hidden parse(const std::string& text) {
  truth::Hidden hidden;
  const std::size_t colon = text.find(':'), at = text.find('@');
  hidden.name = text.substr(0, std::min(colon, at));
  if (at != std::string::npos)
    hidden.axis = text.substr(at + 1, colon == std::string::npos ? colon : colon - at - 1);
  if (colon == std::string::npos) return hidden;
  std::size_t read = 0;
  const std::string number = text.substr(colon + 1);
  try {
    hidden.amplitude = std::stod(number, &read);
  } catch (const std::exception&) {
    read = 0;
  }
  if (read == 0 || read != number.size())
    throw std::invalid_argument("effect = " + text + ": amplitude is not a number");
  return hidden;
}

void list() {
  for (const truth::EffectKind& kind : truth::effect_kinds()) {
    std::string axes;
    for (const std::string& axis : kind.axes) axes += (axes.empty() ? "" : "|") + axis;
    std::printf("%-28s %-18s %s%s\n", kind.name.c_str(), axes.c_str(), kind.in_library ? "" : "(unknown) ",
                kind.form.c_str());
  }
  std::printf("\nruns:");
  for (const std::string& kind : truth::run_kinds()) std::printf(" %s", kind.c_str());
  std::printf("\n");
}

void print_size(const truth::Case& request) {
  const truth::Size size = truth::effect_size(request);
  constexpr std::array kColumns{"trolley_position_m", "slew_angle_rad", "swing_radial_rad",
                                "swing_tangential_rad"};
  for (std::size_t i = 0; i < kColumns.size(); ++i)
    std::printf("%-22s effect %.3g  disturbance %.3g\n", kColumns[i], size.effect[i], size.disturbance[i]);
  std::printf("largest ratio %.3g\n", size.ratio);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Writes measured data of a crane with hidden causes (train_N.csv, test_N.csv) and the sealed answer "
      "(answer.json).\nExample: crane-truth --effect command_delay@trolley:2 --seed 7 --out data"};
  truth::Case request;
  std::vector<std::string> effects;
  std::string out;
  bool listed = false, clean = false, size = false;
  app.add_option("--rig", request.rig, "tower, gantry, drive_axis or pendulum")->capture_default_str();
  app.add_option("--effect", effects, "NAME[@AXIS][:AMPLITUDE], repeatable; amplitude 1 is clearly visible");
  app.add_option("--seed", request.seed, "same seed, same bytes")->capture_default_str();
  app.add_option("--runs", request.training_runs, "training runs; --list prints their names")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--test", request.test_runs, "held-out runs")->delimiter(',')->capture_default_str();
  app.add_option("--seconds", request.seconds, "length of every run; 0: usual length of the run")
      ->check(CLI::Range(0.0, 600.0));
  app.add_option("--disturbance", request.disturbance, "multiple of the usual disturbance")
      ->check(CLI::Range(0.0, 100.0));
  app.add_flag("--clean", clean, "no sensor noise, no rounding");
  app.add_flag("--size", size,
               "also print the deviations by the causes and by the disturbance, in windows of 2 s");
  app.add_flag("--list", listed, "print causes and runs");
  app.add_option("--out", out, "directory of the files");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    if (listed) list();
    for (const std::string& text : effects) request.effects.push_back(parse(text));
    request.sensor_noise = !clean;
    if (!out.empty()) truth::write(truth::generate(request), out);
    if (size) print_size(request);
    if (out.empty() && !listed && !size) throw std::invalid_argument("--out DIR is missing; see --help");
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "crane-truth: %s\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "crane-truth: %s\n", e.what());
    return 1;
  }
  return 0;
}
