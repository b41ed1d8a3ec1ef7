#include "tuning/tune.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/files/complete_file.hpp"
#include "crane/identification/friction.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/report/page.hpp"
#include "experiments/lockstep_run.hpp"
#include "experiments/realtime_session.hpp"
#include "tuning/drawn_rigs.hpp"
#include "tuning/motion.hpp"
#include "tuning/wiring.hpp"

namespace crane::tuning {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

/// Appends the rows of a motion; its first row is one period after the last row of `all`.
void append(recording::Table& all, const recording::Table& motion, double period_s) {
  if (all.columns.empty()) {
    all = motion;
    return;
  }
  const auto *so_far = all.find("time_s"), *added = motion.find("time_s");
  const bool both = so_far != nullptr && !so_far->empty() && added != nullptr && !added->empty();
  const double shift_s = both ? so_far->back() + period_s - added->front() : 0;
  for (auto& column : all.columns) {
    const auto* values = motion.find(column.name);
    if (values == nullptr) throw experiments::RunError("the motions have different columns: " + column.name);
    for (const double value : *values)
      column.values.push_back(column.name == "time_s" ? value + shift_s : value);
  }
}

/// @throws configuration::ConfigurationError when a file of the tuning is one of its inputs
void require_other_files(const configuration::Rig& rig, const TuneOptions& options) {
  auto inputs = options.inputs;
  if (fs::exists(rig.path)) inputs.emplace_back(rig.path);  // a rig can also be made without a file
  std::vector<fs::path> outputs;
  for (const char* name : {kMotionFile, kJsonFile, kRigFile, kPageFile, kMotionRigFile})
    outputs.push_back(options.directory / name);
  configuration::require_other(outputs, configuration::with_base_files(inputs));
}

class Tuner {
 public:
  Tuner(const configuration::Rig& rig, CraneAccess& crane, const TuneOptions& options)
      : rig_{rig}, crane_{crane}, options_{options}, careful_{careful_rig(rig, options.priors)} {
    if (auto found = problems(rig); !found.empty()) throw configuration::ConfigurationError(std::move(found));
    result_.seed = options.seed;
    require_other_files(rig, options);
    fs::create_directories(options.directory);
    for (const char* name : {kMotionFile, kJsonFile, kPageFile, kRigFile})
      files::require_writable(file(name));
  }

  TuneResult run() {
    try {
      move();
      identify_rig();
      if (options_.recommend) recommend_law();
    } catch (const identification::IdentificationError& error) {
      refuse({error.what()});
    } catch (const experiments::RunError& error) {
      refuse({error.what()});
    } catch (const experiments::SessionError& error) {
      refuse({error.what()});
    }
    files::write_file(file(kJsonFile), to_json(result_, rig_).dump(2) + "\n");
    report::write_html(file(kPageFile), page_of(result_, rig_, all_));
    files::write_file(file(kRigFile), rig_text(result_));  // last: the other files describe it
    return std::move(result_);
  }

 private:
  [[nodiscard]] fs::path file(const std::string& name) const { return options_.directory / name; }

  void move() {
    for (const std::size_t axis : {plant::kTrolley, plant::kSlew}) {
      if (!rig_.drives[axis].present) continue;
      const auto rough = probe_axis(axis);
      options_.progress(std::string{"main motion of the "} + plant::kCoordinates[axis].name);
      const auto motion =
          execute(compensated(careful_, axis, rough), main_motion(careful_, options_.priors, axis, rough));
      if (!motion.stopped_because.empty()) refuse_stop(motion.stopped_because);
      motions_.of_axis[axis] = motion.table;
    }
  }

  Rough probe_axis(std::size_t axis) {
    double friction_low_v = 0;  // from the probes so far
    for (const double level : kProbeLevels) {
      options_.progress(std::string{"probe of the "} + plant::kCoordinates[axis].name + " up to " +
                        recording::shortest(level * rig_.drives[axis].volt_limit_v) + " V");
      auto possible = possible_from(rig_, options_.priors, axis);
      if (cable_) {
        const auto known = possible_from(Rough{cable_->value, cable_->standard_error, 0});
        possible.cable_low_m = known.cable_low_m;
        possible.cable_high_m = known.cable_high_m;
      }
      possible.friction_low_v = std::min(friction_low_v, possible.friction_high_v);
      const auto motion = execute(careful_, probe(careful_, options_.priors, axis, level, possible));
      auto finding = examine_probe(motion, rig_, axis, level == kProbeLevels.back());
      if (!finding.problems.empty()) refuse(finding.problems);
      if (!motion.stopped_because.empty()) refuse_stop(motion.stopped_because);
      if (!finding.moved) {
        friction_low_v = std::max(friction_low_v, finding.friction_low_v);
        continue;
      }
      if (auto wrong = examine_swing(motion, rig_, axis); !wrong.empty()) refuse(wrong);
      if (!cable_) {
        std::vector<diagnosis::PreparedRun> runs;
        runs.push_back(prepared(motion.table, rig_));
        cable_ = fit_load(runs, rig_, options_.priors).cable_m;
      }
      return {cable_->value, cable_->standard_error, finding.friction_v};
    }
    throw experiments::RunError("no probe moved the axis");  // examine_probe() names the last probe
  }

  Motion execute(const configuration::Rig& rig, const experiment::Scenario& scenario) {
    auto motion = crane_.execute(rig, scenario);
    if (const auto* time_s = motion.table.find("time_s"); time_s != nullptr && !time_s->empty())
      result_.motion_s += time_s->back();
    append(all_, motion.table, rig_.period_s);
    recording::write_csv(file(kMotionFile), all_);
    std::ranges::copy(motion.differences, std::back_inserter(result_.differences));
    require_every_tick(motion.table);
    return motion;
  }

  void identify_rig() {
    options_.progress("identification");
    result_.identification = identify(motions_, rig_, options_.priors);
    identified_ = true;
    if (const auto lines = outside(result_.identification.values, rig_, options_.priors); !lines.empty())
      refuse(lines);
    // Parses the file as the processes do, because the design contains values derived from others.
    const auto tuned = configuration::parse_rig(
        configuration::to_toml(with_identified(rig_, result_.identification.values)), rig_.path);
    const auto& hoist = rig_.drives[plant::kHoist];
    const double cable_m = tuned.start.position[plant::kHoist];
    if (hoist.present && (cable_m < hoist.low_limit || cable_m > hoist.high_limit))
      refuse({rig_.path + ": drive.hoist: the identified cable length of " + recording::shortest(cable_m) +
              " m is outside low_limit and high_limit"});
    result_.tuned = tuned;
  }

  void recommend_law() {
    const auto maneuvers = maneuvers_for(result_.tuned, options_.maneuvers);
    if (maneuvers.empty())
      refuse({rig_.path +
              ": drive: no maneuver fits the axes and their limits, so that no law can be compared"});
    const auto drawn = drawn_rigs(result_.tuned, result_.identification.values, kDrawnRigs, options_.seed);
    result_.recommendation = recommend({.truth = result_.tuned,
                                        .rig = result_.tuned,
                                        .drawn = drawn,
                                        .maneuvers = maneuvers,
                                        .candidates = options_.candidates,
                                        .processors = options_.processors,
                                        .progress = [this](std::size_t runs) {
                                          if (runs % 20 == 0)
                                            options_.progress(std::to_string(runs) + " maneuvers simulated");
                                        }});
    if (!result_.recommendation.winner) refuse({no_law()});
    result_.tuned = with_candidate(result_.tuned,
                                   result_.recommendation.entries[*result_.recommendation.winner].candidate);
  }

  [[nodiscard]] std::string no_law() const {
    const auto [settled, held, certain] = counts(result_.recommendation);
    return "no law can be recommended: of " + std::to_string(result_.recommendation.entries.size()) +
           " combinations of law and gains, " + std::to_string(settled) +
           " settle in every maneuver on the identified rig, " + std::to_string(held) +
           " of these have a delay margin of " + recording::shortest(kRequiredDelay_periods) +
           " period, a gain margin of " + recording::shortest(kRequiredGain) +
           " and survive the changes of the rig, and " + std::to_string(certain) +
           " of these settle on all " + std::to_string(kDrawnRigs) + " rigs drawn from the standard errors";
  }

  [[noreturn]] void refuse_stop(const std::string& cause) {
    refuse({"the crane stopped during the motion: " + cause});
  }

  /// Writes the results so far, then throws TuningRefused.
  [[noreturn]] void refuse(std::vector<std::string> reasons) {
    std::ranges::copy(result_.differences, std::back_inserter(reasons));
    nlohmann::ordered_json json{{"refused", reasons}};
    if (identified_)
      json.update(to_json(result_, rig_));
    else
      json["motion_s"] = result_.motion_s;
    files::write_file(file(kJsonFile), json.dump(2) + "\n");
    std::string text = joined(reasons) + "\nwritten: ";
    if (!all_.columns.empty()) text += file(kMotionFile).string() + ", ";
    text += file(kJsonFile).string();
    std::string earlier;
    for (const char* name : {kRigFile, kPageFile})
      if (fs::exists(file(name))) earlier += (earlier.empty() ? "" : ", ") + file(name).string();
    throw TuningRefused(text + (earlier.empty() ? "" : "\nunchanged, of an earlier tuning: " + earlier));
  }

  const configuration::Rig& rig_;
  CraneAccess& crane_;
  const TuneOptions& options_;
  configuration::Rig careful_;
  TuneResult result_;
  MainMotions motions_;
  recording::Table all_;
  std::optional<Value> cable_;  ///< rough
  bool identified_ = false;
};

}  // namespace

TuneResult tune(const configuration::Rig& rig, CraneAccess& crane, const TuneOptions& options) {
  return Tuner{rig, crane, options}.run();
}

}  // namespace crane::tuning
