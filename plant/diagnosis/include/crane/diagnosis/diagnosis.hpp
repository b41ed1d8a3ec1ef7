#pragma once
/// Diagnosis of a simulation by measured data: causes, extended model, gain (docs/diagnosis.md).
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crane/diagnosis/accuracy.hpp"
#include "crane/diagnosis/candidate.hpp"
#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

enum class Verdict {
  none,       ///< these data show no error beyond the accuracy of the rig file
  named,      ///< the model lacks the causes
  ambiguous,  ///< several causes explain the data equally well; next_experiment separates them
  parameter,  ///< a quantity of the model has another value than in the rig file
  unknown,    ///< no candidate explains the error
};
[[nodiscard]] const char* name_of(Verdict verdict);

struct Estimate {
  std::string name, unit;
  double value = 0, std_dev = 0;
};

struct Cause {
  std::string name, axis;
  std::vector<Estimate> parameters;
  double p_value = 1;               ///< p value of the score test of this cause
  double resampling_frequency = 0;  ///< share of the votes in the block bootstrap
};

/// A fitted hypothesis, for the table of the report.
struct Ranked {
  std::string label;
  std::vector<Estimate> parameters;
  /// Decrease of the deviance: minus twice the log likelihood of the training data plus the penalty of the
  /// parameters.
  double train_gain = 0;
  double p_value = 1, resampling_frequency = 0;
};

/// Held-out simulation error per output column.
struct HeldOut {
  std::map<std::string, double> baseline_rms, extended_rms;  ///< m or rad, in windows
  /// Training error of the extended model, caused by sensor and disturbance, m or rad.
  std::map<std::string, double> noise;
  std::map<std::string, double> whole_baseline_rms, whole_extended_rms;  ///< whole runs, open loop
  /// Error of a model that holds the first measured value, m or rad; a useful simulation has a smaller error.
  std::map<std::string, double> held_value_rms, whole_held_value_rms;
  /// Standard deviation of simulated / of measured motion in whole runs; 0: the extended model stands still.
  std::map<std::string, double> whole_extended_motion;
  double gain = 0;  ///< 1 - extended / baseline, noise-weighted, over the columns that the causes act on
  std::array<double, 2> gain_ci95{0, 0};
  /// Log likelihood ratio of the held-out data [nats], extended model over base model, each with its own
  /// noise model.
  double nats = 0;
  double likelier = 0;  ///< share of the resamples of the blocks in which the ratio is positive
};

/// A quantity of the rig file with its best estimate within the accuracy of the rig file.
struct Calibrated {
  std::string name, axis;  ///< of the term that changes the quantity
  struct Parameter {
    std::string name, unit;
    double value = 0, null = 0;  ///< null: leaves the quantity of the rig file unchanged
    double limit = 0;            ///< largest difference from `null` within the accuracy of the rig file
  };
  std::vector<Parameter> parameters;
};

/// Residual of the extended model, and the variables that it depends on.
struct ResidualPattern {
  double predictable_fraction = 0;  ///< cross-validated
  std::vector<std::string> from;
};

/// Visibility of one candidate in the training data.
struct Visibility {
  std::string label, cause, axis;
  bool visible = false;  ///< true: the smallest detectable size is within the bounds of the parameters
  std::vector<Estimate>
      least;  ///< smallest size that is found in 9 of 10 such data sets; empty: no size is found
  struct Alike {
    std::string label;
    double cosine = 0;  ///< cosine of their whitened slopes; 1: equal
  };
  std::vector<Alike> alike;  ///< candidates that these data hardly separate, the most similar first
};

struct NextExperiment {
  std::string name;         ///< of the motion
  std::string description;  ///< one sentence
  double separation = 0;    ///< difference of the predictions, in standard deviations of the noise
  std::string scenario;     ///< file for `crane run`
};

/// One column of one held-out run, for overlays.
struct Trace {
  std::string run, column;
  std::vector<double> time_s, measured, baseline, extended;
};

struct Diagnosis {
  Verdict verdict = Verdict::none;
  std::string sentence;       ///< the verdict as a sentence
  std::vector<Cause> causes;  ///< confirmed, or ambiguous
  /// Inaccuracies: accepted candidates within the stated accuracy of the rig file. They do not decide the
  /// verdict.
  std::vector<Cause> within_accuracy;
  std::vector<Calibrated> calibrated;
  std::vector<Cause> attempted;  ///< with `unknown`: best explanation, unproven
  std::vector<std::string> ambiguous_with;
  std::optional<NextExperiment> next_experiment;
  HeldOut held_out;
  ResidualPattern remainder;
  std::vector<Ranked> ranking;
  std::vector<Trace> traces;
  std::vector<plant::TermSetting> extension;  ///< terms to append to those of the rig
  std::vector<std::string> notes;
  std::vector<Visibility> excitation;  ///< visibility in the training data
  double detection_p_value = 1;        ///< p value of the largest score of all candidates
  Accuracy accuracy{};                 ///< of the request
  double runtime_s = 0;
};

/// Visibility of all candidates before any fit, and experiments for the candidates that are not visible.
struct Check {
  std::vector<Visibility> excitation;
  struct Proposal {
    std::string of, from;  ///< the experiment shows one candidate, or separates two
    NextExperiment motion;
  };
  std::vector<Proposal> next;
};

struct Request {
  std::uint64_t seed = 1;  ///< of the resampling
  std::size_t most_effects = 3;
  std::vector<std::string> excluded{};  ///< causes that are excluded from the candidates
  Accuracy accuracy = kUsualAccuracy;   ///< of the rig file
  /// Called with the share done, 0..1, and the current step.
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// @param train,test parts of runs (load_run); all parts of one run belong to the same side
/// @throws DataError for data that are too short or without motion
[[nodiscard]] Diagnosis diagnose(const configuration::Rig& rig, std::vector<Run> train, std::vector<Run> test,
                                 const Request& request = {});

/// @throws DataError as diagnose()
[[nodiscard]] Check check(const configuration::Rig& rig, std::vector<Run> train, const Request& request = {});

}  // namespace crane::diagnosis
