#pragma once
/// The numbers that decide a verdict. report.json prints them, docs/diagnosis.md lists them.
#include <array>

namespace crane::diagnosis {

struct Rule {
  const char* name;
  double value;
  const char* unit;  ///< "1": a share or a ratio
  const char* meaning;
  const char* source;  ///< level of a test, physical bound, or "read off examples"
  constexpr operator double() const { return value; }  // NOLINT: a rule is used as its number
};

namespace rules {

// Acceptance of an effect (search/compare.cpp).
inline constexpr Rule kLuckOfTheBest{"luck_of_the_best", 0.05, "1",
                                     "chance that luck makes the best of all candidates acceptable",
                                     "level of the test, Bonferroni"};
inline constexpr Rule kSignificant{"significant", 0.01, "1", "chance of a score below which it is not luck",
                                   "level of the test"};
inline constexpr Rule kLeastAlone{"least_share_alone", 0.01, "1",
                                  "least share of the error of a column that a first effect takes off",
                                  "read off examples"};
inline constexpr Rule kLeastBeside{"least_share_beside", 0.2, "1",
                                   "the same of a further effect, of the error that the others leave",
                                   "read off examples"};

// A name among hypotheses of as many effects (verdict/judgement.cpp).
inline constexpr Rule kClearWin{"clear_win", 0.8, "1", "share of block resamples that a named cause wins",
                                "level of the vote"};
inline constexpr Rule kRunnerUp{"runner_up", 0.1, "1", "share of block resamples that makes a rival",
                                "level of the vote"};

// Proof on held-out runs (verdict/diagnose.cpp).
inline constexpr Rule kHeldOutWin{"held_out_win", 0.95, "1",
                                  "share of resampled held-out blocks that the extended model makes likelier",
                                  "level of the test"};
inline constexpr Rule kWorthwhile{
    "worthwhile", 0.03, "1",
    "least share of the held-out error of a column that the extended model takes off", "read off examples"};
inline constexpr Rule kStandsStill{
    "stands_still", 0.1, "1", "simulated motion as a share of the measured motion, below which it is none",
    "definition"};
inline constexpr Rule kWorseOverWholeRuns{
    "worse_over_whole_runs", 1.25, "1",
    "error of a swing over whole runs, extended over base model, beyond which it is worse",
    "read off examples"};
inline constexpr Rule kStillFollowed{
    "still_followed", 0.5, "1",
    "squares of a drive's motion that the extended model follows, over those of the base model",
    "read off examples"};

// What is left is too much (verdict/judgement.cpp, verdict/leftovers.cpp).
inline constexpr Rule kWorstLoss{"worst_loss", 1.25, "1",
                                 "mean loss of the innovations; 1 where the noise is as learnt",
                                 "read off examples"};
inline constexpr Rule kNotFollowed{
    "not_followed", 0.4, "1",
    "root mean square of what is left of a swing in windows, as a share of its motion", "read off examples"};
inline constexpr Rule kSwings{
    "swings", 0.01, "rad", "least root mean square of a swing of which that is asked", "read off examples"};
inline constexpr Rule kCredibleForce{
    "credible_force", 0.03, "1", "disturbance of the load, rms, as a share of its weight",
    "half a newton on two kilograms: wind and hands at a laboratory's crane"};
inline constexpr Rule kPattern{
    "pattern", 0.008, "1", "least share of the drives' loss of a pattern that counts", "read off examples"};
inline constexpr Rule kPatternLuck{"pattern_luck", 15, "noise variances", "largest pattern that luck makes",
                                   "read off examples"};
inline constexpr Rule kDoubtful{"doubtful", 0.04, "1", "pattern over all that is wrong with the base model",
                                "read off examples"};
inline constexpr Rule kDoubtfulOfItsOwn{"doubtful_of_its_own", 0.1, "1",
                                        "the same of a pattern in the variable of one effect's law",
                                        "read off examples"};
inline constexpr Rule kDoubtfulOfSeveralLaws{"doubtful_of_several_laws", 0.01, "1",
                                             "the same of a pattern in the variable of several effects' laws",
                                             "read off examples"};
inline constexpr Rule kDoubtfulOverTime{"doubtful_over_time", 0.01, "1", "the same of a pattern over time",
                                        "read off examples"};
inline constexpr Rule kDoubtfulOfOneName{"doubtful_of_one_name", 0.5, "1",
                                         "pattern over what one of the names explains on its axis",
                                         "read off examples"};

inline constexpr std::array kAll{
    kLuckOfTheBest,    kSignificant,      kLeastAlone,  kLeastBeside,      kClearWin,
    kRunnerUp,         kHeldOutWin,       kWorthwhile,  kStandsStill,      kWorseOverWholeRuns,
    kStillFollowed,    kWorstLoss,        kNotFollowed, kSwings,           kCredibleForce,
    kPattern,          kPatternLuck,      kDoubtful,    kDoubtfulOfItsOwn, kDoubtfulOfSeveralLaws,
    kDoubtfulOverTime, kDoubtfulOfOneName};

}  // namespace rules
}  // namespace crane::diagnosis
