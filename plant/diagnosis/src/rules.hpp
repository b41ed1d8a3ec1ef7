#pragma once
/// Thresholds that decide a verdict. report.json prints them; docs/diagnosis_thresholds.md lists them.
#include <array>
#include <cstddef>

namespace crane::diagnosis {

struct Rule {
  const char* name;
  double value;
  const char* unit;  ///< "1": a share or a ratio
  const char* meaning;
  const char* source;  ///< level of a test, physical bound, or "read off examples"
  constexpr operator double() const { return value; }  // NOLINT: a rule is used as its number
  /// @pre the value is a count
  [[nodiscard]] constexpr std::size_t count() const { return static_cast<std::size_t>(value); }
};

namespace rules {

// Resampling.
inline constexpr Rule kVotes{"votes", 500, "resamples", "block resamples that vote for a hypothesis",
                             "chosen: a share of 95 % has a standard error of 1 %"};
inline constexpr Rule kResamples{"resamples", 1000, "resamples", "resamples of the held-out gain",
                                 "chosen: the ends of the interval have 25 resamples beyond them"};
inline constexpr Rule kResamplings{"resamplings", 400, "resamples",
                                   "block resamples of the profile of a parameter",
                                   "chosen: a standard deviation has an error of 4 %"};
inline constexpr Rule kSignFlips{"sign_flips", 999, "sign flips",
                                 "sign flips of the scores of the blocks (min-P)",
                                 "smallest possible p value: 0.1 %"};
inline constexpr Rule kFlips{"flips", 99, "sign flips", "sign flips of a pattern of force or of a line",
                             "smallest possible p value: 1 %"};
inline constexpr Rule kFolds{"folds", 4, "folds", "folds of the cross-validation of a pattern or a line",
                             "chosen: three of the four must agree"};

// Acceptance of a cause.
inline constexpr Rule kFamilywiseLevel{"familywise_level", 0.05, "1",
                                       "probability that any candidate without an effect is accepted",
                                       "level of the test, Bonferroni"};
inline constexpr Rule kSignificant{
    "significant", 0.01, "1",
    "level of the tests of scores, rivals, drive errors, narrow bands and short forces", "level of the test"};
inline constexpr Rule kLeastAlone{"least_alone", 0.01, "1",
                                  "minimum reduction of the error of an output by the first cause",
                                  "read off examples"};
inline constexpr Rule kLeastBeside{
    "least_beside", 0.09, "1",
    "minimum change of an output by a further cause / largest change of this output by another cause of the "
    "same hypothesis",
    "square root of indistinct: the equation of a term describes a crane with an error of this share"};

// Choice among hypotheses with the same number of causes.
inline constexpr Rule kClearWin{"clear_win", 0.8, "1", "minimum share of block resamples for a named cause",
                                "level of the vote"};
inline constexpr Rule kRunnerUp{"runner_up", 0.1, "1", "minimum share of block resamples for a rival",
                                "level of the vote"};
inline constexpr Rule kIndistinct{"indistinct", 0.008, "1",
                                  "largest difference of deviance between a rival and the best hypothesis / "
                                  "decrease of the deviance from the base model to the best hypothesis, at "
                                  "which both count as equal",
                                  "as pattern: the equations of the terms leave this share of the loss"};

inline constexpr Rule kRarerCause{"rarer_cause", 6.63, "1",
                                  "decrease of the deviance by which a rarer cause must exceed a more common "
                                  "one with nearly the same effect",
                                  "convention: 99 % quantile of chi-square with one degree of freedom"};

// Confirmation on held-out runs.
inline constexpr Rule kHeldOutWin{
    "held_out_win", 0.95, "1", "minimum share of held-out resamples in which the extended model is likelier",
    "level of the test"};
inline constexpr Rule kGainLevel{
    "gain_level", 0.95, "1",
    "level of the interval of the held-out gain, whose upper end must not be below 0", "level of the test"};
inline constexpr Rule kWorthwhile{
    "worthwhile", 0.03, "1",
    "minimum reduction of the training error at which an extension that the held-out runs do not confirm is "
    "evidence of an error",
    "read off examples"};
inline constexpr Rule kStandsStill{"stands_still", 0.1, "1",
                                   "simulated motion / measured motion below which the model stands still",
                                   "definition"};
inline constexpr Rule kWorseOverWholeRuns{"worse_over_whole_runs", 1.25, "1",
                                          "maximum error of a swing over whole runs, extended / base model",
                                          "read off examples"};
inline constexpr Rule kStillFollowed{
    "still_followed", 0.5, "1",
    "minimum share of a drive's motion over whole runs that the model follows, extended / base model; the "
    "comparison needs a base model that follows this share of the measured motion",
    "read off examples"};

// Residual that is too large or predictable.
inline constexpr Rule kWorstLoss{"worst_loss", 1.25, "1",
                                 "maximum mean loss of the innovations; 1 for noise as learnt",
                                 "read off examples"};
inline constexpr Rule kNotFollowed{"not_followed", 0.4, "1",
                                   "maximum rms of the residual of a swing in windows / rms of the swing",
                                   "read off examples"};
inline constexpr Rule kDriveError{
    "drive_error", 3, "standard uncertainties",
    "error of a drive in a window above which the window counts as not explained; the verdict is unknown if "
    "significantly many windows are not explained",
    "coverage factor 3 of a normal error: 0.27 % of the windows"};
inline constexpr Rule kLeastSwingRms{"least_swing_rms", 0.01, "m or rad",
                                     "minimum rms of a motion to which not_followed applies",
                                     "read off examples"};
inline constexpr Rule kCredibleForce{
    "credible_force", 0.03, "1", "maximum rms of the disturbance of the load / its weight",
    "half a newton on two kilograms: wind and hands at a laboratory's crane"};
inline constexpr Rule kCredibleDrive{
    "credible_drive", 0.005, "1",
    "maximum rms of the disturbance of a drive / its acceleration at the largest voltage",
    "read off examples"};
inline constexpr Rule kPattern{"pattern", 0.008, "1", "minimum share of a pattern in the loss of the drives",
                               "read off examples"};
inline constexpr Rule kPatternLuck{
    "pattern_luck", 15, "noise variances",
    "smallest decrease of the loss at which a pattern counts; patterns of pure noise stay below",
    "read off examples"};
inline constexpr Rule kPatternShare{
    "pattern_share", 0.04, "1",
    "smallest pattern / loss of the base model at which a pattern counts, if no found cause has a law in its "
    "variable",
    "read off examples"};
inline constexpr Rule kPatternShareOneTerm{"pattern_share_one_term", 0.1, "1",
                                           "the same for a pattern in the variable of the law of one cause",
                                           "read off examples"};
inline constexpr Rule kPatternShareSeveralTerms{
    "pattern_share_several_terms", 0.01, "1",
    "the same for a pattern in the variable of the laws of several causes", "read off examples"};
inline constexpr Rule kPatternShareOverTime{"pattern_share_over_time", 0.01, "1",
                                            "the same for a pattern over time", "read off examples"};
inline constexpr Rule kPatternShareOfCause{"pattern_share_of_cause", 0.5, "1",
                                           "smallest pattern / part of the loss that the weakest cause on "
                                           "the axis explains, at which a pattern counts",
                                           "read off examples"};

// Lines (forces of one frequency) and jumps.
inline constexpr Rule kCommandLevel{"command_level", 0.01, "1",
                                    "level of the test whether the commands of a run contain a line",
                                    "level of the test (Rayleigh)"};
inline constexpr Rule kLeastOfCommand{
    "least_of_command", 0.5, "1",
    "minimum force of a line / command of its frequency, if the command contains the line",
    "the command of a controller that answers a force is at most twice the force (complementary "
    "sensitivity)"};
inline constexpr Rule kLineOfDrives{"line_of_drives", 0.025, "1",
                                    "minimum share of a line in the loss of the drives",
                                    "below this share a line has no consequence for the crane"};
inline constexpr Rule kLineOfLoad{"line_of_load", 0.012, "1",
                                  "minimum share of a line in the loss of the load",
                                  "below this share a line has no consequence for the crane"};
inline constexpr Rule kClearJumpStatistic{"clear_jump_statistic", 50, "noise variances",
                                          "minimum statistic of a clear jump of position or speed",
                                          "read off examples: clean data reach 20"};
inline constexpr Rule kFewestJumpingPieces{"fewest_jumping_pieces", 3, "pieces",
                                           "minimum number of pieces with a clear jump", "read off examples"};

inline constexpr std::array kAll{kVotes,
                                 kResamples,
                                 kResamplings,
                                 kSignFlips,
                                 kFlips,
                                 kFolds,
                                 kFamilywiseLevel,
                                 kSignificant,
                                 kLeastAlone,
                                 kLeastBeside,
                                 kClearWin,
                                 kRunnerUp,
                                 kIndistinct,
                                 kRarerCause,
                                 kHeldOutWin,
                                 kGainLevel,
                                 kWorthwhile,
                                 kStandsStill,
                                 kWorseOverWholeRuns,
                                 kStillFollowed,
                                 kWorstLoss,
                                 kNotFollowed,
                                 kDriveError,
                                 kLeastSwingRms,
                                 kCredibleForce,
                                 kCredibleDrive,
                                 kPattern,
                                 kPatternLuck,
                                 kPatternShare,
                                 kPatternShareOneTerm,
                                 kPatternShareSeveralTerms,
                                 kPatternShareOverTime,
                                 kPatternShareOfCause,
                                 kCommandLevel,
                                 kLeastOfCommand,
                                 kLineOfDrives,
                                 kLineOfLoad,
                                 kClearJumpStatistic,
                                 kFewestJumpingPieces};

}  // namespace rules
}  // namespace crane::diagnosis
