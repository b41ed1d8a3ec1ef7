#pragma once
/// What the simulation of a rig gets wrong, by the measured data: the cause, the extended model and the gain.
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

enum class Verdict {
  none,       ///< nothing that this data could show is wrong
  named,      ///< causes that explain what the model got wrong
  ambiguous,  ///< several explain it alike; next_experiment tells them apart
  parameter,  ///< a quantity the model has, with another value than the rig file's
  unknown,    ///< something is wrong that no candidate explains
};
[[nodiscard]] const char* name_of(Verdict verdict);

struct Estimate {
  std::string name, unit;
  double value = 0, std_dev = 0;
};

struct Cause {
  std::string name, axis;
  std::vector<Estimate> parameters;
  double p_value = 1;               ///< of the score test by itself
  double resampling_frequency = 0;  ///< share of resamples of the data that pick it
};

/// One candidate after its fit, for the table of the report.
struct Ranked {
  std::string label;
  std::vector<Estimate> parameters;
  /// Decrease of minus twice the log likelihood of the training data, each block left out of the fit.
  double train_gain = 0;
  double p_value = 1, resampling_frequency = 0;
};

/// Held-out simulation error per output column.
struct HeldOut {
  std::map<std::string, double> baseline_rms, extended_rms;  ///< m or rad, in windows
  /// What sensors and disturbance alone give: training error of the extended model, m or rad.
  std::map<std::string, double> noise;
  std::map<std::string, double> whole_baseline_rms, whole_extended_rms;  ///< whole runs, open loop
  /// What a model leaves that holds the first measured value, in windows and over whole runs. A simulation
  /// that is no better than this says nothing about the motion.
  std::map<std::string, double> held_value_rms, whole_held_value_rms;
  /// Share of the measured motion over whole runs that the extended model makes: 0 where it stands still.
  std::map<std::string, double> whole_extended_motion;
  double gain = 0;  ///< 1 - extended / baseline, noise-weighted, over the columns that the causes act on
  std::array<double, 2> gain_ci95{0, 0};
  /// How much likelier the extended model makes the held-out data than the base model, each in the noise that
  /// it was fitted in [nats], and the share of resamples of the blocks in which it does.
  double nats = 0, likelier = 0;
};

/// What is left after the extended model, and what it goes with.
struct Remainder {
  double predictable_fraction = 0;  ///< cross-validated
  std::vector<std::string> from;
};

/// What the data can show of one candidate, whatever they say.
struct Visibility {
  std::string label, cause, axis;
  bool visible = false;  ///< whether an effect inside its bounds would be found
  std::vector<Estimate>
      least;  ///< the least that would be found, in 9 of 10 data sets; empty: nothing shows it
  struct Alike {
    std::string label;
    double cosine = 0;  ///< between the changes of the two, 1: the same
  };
  std::vector<Alike> alike;  ///< hardly told from it by these data, most alike first
};

struct NextExperiment {
  std::string name;         ///< of the menu
  std::string description;  ///< one sentence
  double separation = 0;    ///< how far apart the candidates' predictions lie, in noise standard deviations
  std::string scenario;     ///< file for `crane run`
};

/// Overlays for the report: one held-out run.
struct Trace {
  std::string run, column;
  std::vector<double> time_s, measured, baseline, extended;
};

struct Diagnosis {
  Verdict verdict = Verdict::none;
  std::string sentence;          ///< the verdict in words
  std::vector<Cause> causes;     ///< proven, or ambiguous
  std::vector<Cause> attempted;  ///< unknown: what explains most of it; no cause
  std::vector<std::string> ambiguous_with;
  std::optional<NextExperiment> next_experiment;
  HeldOut held_out;
  Remainder remainder;
  std::vector<Ranked> ranking;
  std::vector<Trace> traces;
  std::vector<plant::TermSetting> extension;  ///< terms to append to the rig's
  std::vector<std::string> notes;
  std::vector<Visibility> excitation;  ///< what the training data could show
  double detection_p_value = 1;        ///< that the largest score of all candidates comes from nothing
  double runtime_s = 0;
};

/// What the data can show, before anything is fitted, and what to record for what they cannot.
struct Check {
  std::vector<Visibility> excitation;
  struct Proposal {
    std::string of, from;  ///< shows one candidate, or tells two apart
    NextExperiment motion;
  };
  std::vector<Proposal> next;
};

struct Request {
  std::uint64_t seed = 1;  ///< of the resampling
  std::size_t most_effects = 3;
  std::vector<std::string> excluded{};  ///< causes that are not considered
  /// Called with the share done, 0..1, and what is being done.
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// @param train,test pieces of runs (load_run); whole runs belong to one side
/// @throws DataError when the data cannot tell: too short, nothing moves
[[nodiscard]] Diagnosis diagnose(const configuration::Rig& rig, std::vector<Run> train, std::vector<Run> test,
                                 const Request& request = {});

/// @throws DataError as diagnose()
[[nodiscard]] Check check(const configuration::Rig& rig, std::vector<Run> train, const Request& request = {});

}  // namespace crane::diagnosis
