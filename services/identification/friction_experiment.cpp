#include "identification/friction_experiment.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/control/tracking_pd.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/files/directory_lock.hpp"
#include "crane/identification/excitation_design.hpp"
#include "crane/plant/coordinates.hpp"
#include "experiments/realtime_run.hpp"
#include "identification/axis_data.hpp"
#include "identification/friction_picture.hpp"

namespace crane::identification {
namespace {

namespace fs = std::filesystem;
namespace id = identification;
using recording::shortest;

constexpr const char* kController = "none";  // tracking PD without anti-swing
constexpr const char* kUncompensated = "uncompensated.toml";
constexpr const char* kIdentified = "identified.toml";
constexpr const char* kResults = "friction.json";
constexpr const char* kPicture = "friction.svg";
// Parts of the experiment: each has a scenario file and a directory.
constexpr const char* kMultiSine = "multi_sine";
constexpr const char* kBreakAway = "break_away";
constexpr const char* kSteps = "steps";
constexpr const char* kStepsUncompensated = "steps_uncompensated";
constexpr std::array kParts{kMultiSine, kBreakAway, kSteps, kStepsUncompensated};
constexpr double kBegin_s = 0.5;
constexpr double kRest_s = 2;  // pause after an excitation
constexpr double kRamp_vps = 0.4;
constexpr int kBreakAways = 4;
constexpr double kStepSpacing_s = 6;

std::string scenario_file(const std::string& part) { return part + ".toml"; }

std::string array_of(const control::Excitation& excitation, double control::Sine::*field) {
  std::string text;
  for (const control::Sine& sine : excitation.sines)
    if (sine.amplitude != 0) text += (text.empty() ? "" : ", ") + shortest(sine.*field);
  return "[" + text + "]";
}

std::string excitation_text(double at_s, const control::Excitation& excitation) {
  const std::string unit = plant::kCoordinates[excitation.axis].unit;
  std::string text = "\n[[excitation]]\nat_s = " + shortest(at_s) + "\naxis = \"" +
                     plant::kCoordinates[excitation.axis].name + "\"\nabout_" + unit + " = " +
                     shortest(excitation.mean_position) + "\n";
  if (excitation.duration_s > 0)
    text += "amplitudes_" + unit + " = " + array_of(excitation, &control::Sine::amplitude) +
            "\nfrequencies_hz = " + array_of(excitation, &control::Sine::frequency_hz) +
            "\nduration_s = " + shortest(excitation.duration_s) + "\n";
  return text;
}

/// Runs the experiments for one axis of a rig.
class Experiment {
 public:
  explicit Experiment(const FrictionExperimentOptions& options)
      : options_{options},
        rig_{configuration::load_rig(options.rig)},
        realtime_runs_{{.plant = options.plant, .bus = options.bus, .vendors = options.vendors}} {
    const auto& drive = rig_.drives[options.axis];
    if (options.axis > plant::kSlew || !drive.present)
      throw configuration::ConfigurationError({rig_.path + ": " + plant::kCoordinates[options.axis].name +
                                               ": this rig has no such drive to identify"});
    require_other_files();
    place();
    measure_loop();
    fs::create_directories(options.directory);
    lock_.emplace(options.directory, files::IfLocked::fail);
    files::write_file(file(kUncompensated), uncompensated());
  }

  FrictionExperimentResult run() {
    FrictionExperimentResult result;
    result.rig = rig_.name;
    result.axis = options_.axis;
    const id::AxisRun multi_sine = run_multi_sine(result);
    result.estimates = estimate_both(multi_sine, options_.zero_band, options_.cutoff_ratio, gain_);
    result.stiction = run_break_away(result.estimates.midpoint);
    result.fragment = file(kIdentified);
    files::write_file(result.fragment, friction_fragment(rig_.path, options_.axis, result.estimates.midpoint,
                                                         result.stiction));
    const Steps compensated = run_steps(kSteps, result.fragment, result);
    const Steps uncompensated = run_steps(kStepsUncompensated, file(kUncompensated), result);
    result.compensated = id::deviation(compensated.measured, compensated.model);
    result.uncompensated = id::deviation(uncompensated.measured, uncompensated.model);
    result.difference_from_start = realtime_runs_.difference_from_start(rig_);
    files::write_file(file(kResults), to_json(result).dump(2) + "\n");
    if (options_.picture)
      draw_friction(file(kPicture), result,
                    {.run = &multi_sine,
                     .cutoff_ratio = options_.cutoff_ratio,
                     .period_s = rig_.period_s,
                     .compensated = &compensated.measured,
                     .uncompensated = &uncompensated.measured,
                     .model = &compensated.model});
    return result;
  }

 private:
  struct Steps {
    std::vector<double> measured, model;
  };

  [[nodiscard]] fs::path file(const std::string& name) const { return options_.directory / name; }

  /// The new rig file extends the rig file: it must not replace it. The runs of the parts check their files.
  void require_other_files() const {
    std::vector<fs::path> outputs;
    for (const char* name : {kUncompensated, kIdentified, kResults, kPicture}) outputs.push_back(file(name));
    for (const char* part : kParts) {
      outputs.push_back(file(scenario_file(part)));
      outputs.push_back(file(part) / "run.csv");
    }
    configuration::require_other(outputs, configuration::with_base_files({options_.rig}));
  }

  /// Places the axis in the middle of its travel; for the slew axis, also the trolley near the tower
  /// (section 4.4.2).
  void place() {
    constexpr double kUsable = 0.95;  // used share of the travel within the soft margins
    const auto& drive = rig_.drives[options_.axis];
    const double middle = (drive.low_limit + drive.high_limit) / 2;
    const double half = (drive.high_limit - drive.low_limit) / 2 - drive.soft_margin;
    limits_.low = middle - kUsable * half;
    limits_.high = middle + kUsable * half;
    limits_.speed = kUsable * drive.max_speed;
    start_ = rig_.start.position;
    start_[options_.axis] = middle;
    const auto& trolley = rig_.drives[plant::kTrolley];
    if (options_.axis == plant::kSlew && trolley.present)
      start_[plant::kTrolley] = trolley.low_limit + 1.05 * trolley.soft_margin;
    if (!rig_.carries_load()) return;
    // Share of the swing limit; the reserve is for harmonics that the friction adds to the reference.
    constexpr double kSwingShare = 0.35;
    limits_.swing_rad = kSwingShare * rig_.limits.swing_limit_rad;
    limits_.load = {
        .cable_m = start_[plant::kHoist], .gravity_mps2 = rig_.design.crane.gravity_mps2, .radius_m = {}};
    if (options_.axis == plant::kSlew) limits_.load.radius_m = start_[plant::kTrolley];
  }

  /// Gains of the tracking PD in volts per m or rad and per m/s or rad/s.
  void measure_loop() {
    const auto law = control::make_tracking_pd(rig_.design);
    control::Measurement measured;
    control::Reference reference;
    for (std::size_t i = 0; i < plant::kAxes; ++i) reference[i].position = measured.position[i] = start_[i];
    constexpr double kSmall = 1e-3;
    reference[options_.axis].position += kSmall;
    loop_.stiffness_vpu = law->step(measured, reference).drive_v[options_.axis] / kSmall;
    reference[options_.axis].position -= kSmall;
    measured.speed[options_.axis] = -kSmall;
    loop_.damping_vspu = law->step(measured, reference).drive_v[options_.axis] / kSmall;
    loop_.period_s = rig_.period_s;
    if (rig_.sensing.filter_speed[options_.axis]) loop_.cutoff_ratio = rig_.sensing.swing_filter_ratio;
  }

  [[nodiscard]] std::string uncompensated() const {
    std::string text = "# " + rig_.name + " without friction compensation\nextends = " +
                       configuration::toml_string(fs::absolute(rig_.path).string()) + "\n";
    for (std::size_t i = 0; i < plant::kAxes; ++i)
      if (rig_.drives[i].present && rig_.design.friction[i].factor > 0)
        text += std::string{"\n[controller.friction."} + plant::kCoordinates[i].name + "]\nfactor = 0.0\n";
    return text;
  }

  [[nodiscard]] std::string scenario_text(const std::string& description, double duration_s) const {
    std::string text = "# Made by crane identify for " + rig_.name + ".\ndescription = \"" + description +
                       "\"\nduration_s = " + shortest(duration_s) + "\n\n[start]\n";
    for (const std::size_t i : {plant::kTrolley, plant::kSlew})
      if (rig_.drives[i].present)
        text += std::string{plant::kCoordinates[i].column} + " = " + shortest(start_[i]) + "\n";
    return text;
  }

  /// Runs one part of the experiment. @return its table
  recording::Table run_part(const std::string& name, const fs::path& rig, const std::string& scenario) {
    files::write_file(file(scenario_file(name)), scenario);
    if (options_.realtime) return run_part_in_realtime(name, rig);
    experiments::ExperimentOptions run;
    run.scenario = file(scenario_file(name));
    run.rig = rig;
    run.controller = kController;
    run.directory = file(name);
    run.plant = options_.plant;
    run.in_process = options_.in_process;
    run.picture = false;
    run.bus = options_.bus;
    run.vendors = options_.vendors;
    const auto result = experiments::run_experiment(run);
    if (!result.outcome.completed)
      throw experiments::RunError(name +
                                  ": the supervisor stopped the crane: " + result.outcome.stopped_because);
    return recording::read_csv(file(name) / "run.csv");
  }

  recording::Table run_part_in_realtime(const std::string& name, const fs::path& rig) {
    const auto scenario = experiment::load_scenario(file(scenario_file(name)), &rig_);
    const auto run = realtime_runs_.run(rig, kController, scenario);
    fs::create_directories(file(name));
    recording::write_csv(file(name) / "run.csv", run.table);
    if (!run.differences.empty())
      throw experiments::RunError(name + ": " + run.differences.front() + "; repeat the experiment");
    return run.table;
  }

  id::AxisRun run_multi_sine(FrictionExperimentResult& result) {
    const double amplitude =
        options_.axis == plant::kTrolley ? id::kTrolleyAmplitude_m : id::kSlewAmplitude_rad;
    const auto excitation = id::multi_sine(options_.axis, amplitude, limits_, options_.duration_s);
    result.amplitude_share = excitation.sines[0].amplitude / (-0.4 * amplitude);
    const auto table =
        run_part(kMultiSine, file(kUncompensated),
                 scenario_text("sum of sines for the friction of one axis", options_.duration_s + kRest_s) +
                     excitation_text(kBegin_s, excitation));
    gain_ = loop_.gain = acting_gain(rig_.design, options_.axis, mean_trolley_position(table));
    return axis_run_from(table, rig_, options_.axis, kBegin_s, kBegin_s + options_.duration_s);
  }

  id::StictionEstimate run_break_away(const id::FrictionEstimate& friction) {
    constexpr double kLeast_v = 0.02;  // smallest identifiable friction: eight steps of the analog output
    const double friction_v = friction.coulomb_positive.value + friction.coulomb_negative.value;
    if (friction_v < kLeast_v)
      throw id::IdentificationError("the Coulomb friction of both directions together is " +
                                    std::to_string(friction_v) +
                                    " V, too small to identify; the axis needs no compensation");
    const auto excitation =
        id::break_away_sine(options_.axis, limits_, loop_.stiffness_vpu, kRamp_vps, friction_v, kBreakAways);
    const auto table =
        run_part(kBreakAway, file(kUncompensated),
                 scenario_text("slow voltage ramps until the axis moves", excitation.duration_s + kRest_s) +
                     excitation_text(kBegin_s, excitation));
    const auto run = axis_run_from(table, rig_, options_.axis, kBegin_s, kBegin_s + excitation.duration_s);
    id::BreakAwayOptions break_away;
    // Counts per window: a slower motion cannot be distinguished from one encoder step.
    constexpr double kCounts = 3;
    break_away.start_speed =
        std::max(break_away.start_speed,
                 kCounts / (rig_.encoders[options_.axis].counts_per_unit * break_away.window_s));
    return id::estimate_stiction(run, break_away);
  }

  /// Length of the step, m or rad: at most half the voltage of the drive, 0.4 of the travel, and half of
  /// limits_.swing_rad as ratio of the step of the support to the cable length.
  [[nodiscard]] double step_size() const {
    constexpr double kVoltShare = 0.5, kTravelShare = 0.4;
    double step = std::min(kVoltShare * rig_.drives[options_.axis].volt_limit_v / loop_.stiffness_vpu,
                           kTravelShare * (limits_.high - limits_.low));
    const double radius_per_cable = std::abs(limits_.load.radius_m.value_or(1)) / limits_.load.cable_m;
    if (limits_.load.cable_m > 0) step = std::min(step, limits_.swing_rad / radius_per_cable / 2);
    return step;
  }

  Steps run_steps(const std::string& name, const fs::path& rig, FrictionExperimentResult& result) {
    result.step = step_size();
    control::Excitation up{.axis = options_.axis, .mean_position = start_[options_.axis] + result.step};
    control::Excitation down{.axis = options_.axis, .mean_position = start_[options_.axis]};
    const auto table =
        run_part(name, rig,
                 scenario_text("a step in each direction, " + name, 2 * kStepSpacing_s) +
                     excitation_text(kBegin_s, up) + excitation_text(kBegin_s + kStepSpacing_s, down));
    const plant::Coordinate& axis = plant::kCoordinates[options_.axis];
    Steps steps;
    steps.measured = *table.find(axis.column);
    auto reference = *table.find(axis.reference);
    for (std::size_t k = 1; k < reference.size(); ++k)  // in real time, a reference may be missing
      if (!std::isfinite(reference[k])) reference[k] = reference[k - 1];
    steps.model = id::linear_response(loop_, reference, steps.measured.front());
    return steps;
  }

  const FrictionExperimentOptions& options_;
  /// The processes of a run read rig files of this directory, which must not be those of another program.
  std::optional<files::DirectoryLock> lock_;
  configuration::Rig rig_;
  experiments::RealtimeRuns realtime_runs_;
  id::ExcitationLimits limits_;
  id::LinearLoop loop_;
  plant::PerAxis start_{};
  double gain_ = 0;
};

}  // namespace

FrictionExperimentResult identify_friction(const FrictionExperimentOptions& options) {
  return Experiment{options}.run();
}

}  // namespace crane::identification
