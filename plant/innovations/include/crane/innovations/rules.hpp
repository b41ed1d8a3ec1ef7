#pragma once
/// Every number that decides something: name, value, unit, meaning, source and the level or error rate that
/// it stands for. The table is printed into the report.
#include <array>
#include <string_view>

namespace crane::innovations {

struct Rule {
  std::string_view name;
  double value;
  std::string_view unit, meaning, source, level;
};

namespace rule {
// Data.
inline constexpr Rule kLeastRows{
    "least_rows", 20, "1", "rows of a run", "two states per degree of freedom need more", "-"};
inline constexpr Rule kBurnIn{
    "burn_in",
    0.5,
    "s",
    "likelihood of a run counts from here on; no sensor delay or start reaches further",
    "largest swing delay of the library 0.4 s",
    "-"};
inline constexpr Rule kFloorShare{"sensor_floor",
                                  1e-5,
                                  "travel",
                                  "least standard deviation of a sensor: presliding below it is not judged",
                                  "presliding of guides and bearings, 10 to 100 um on 1 m",
                                  "-"};
// Filter.
inline constexpr Rule kStudent{"student_nu",
                               5,
                               "1",
                               "degrees of freedom of the innovations' Student t",
                               "Lange, Little, Taylor, JASA 84 (1989) 881",
                               "-"};
inline constexpr Rule kRestSpeed{"rest_speed",
                                 0.003,
                                 "speed98",
                                 "width of dry friction's step at v = 0",
                                 "Karnopp 1985: below it the axis sticks",
                                 "-"};
inline constexpr Rule kRestBand{"rest_band",    10,
                                "rest_speed",   "band in which friction's memory makes white acceleration",
                                "Karnopp 1985", "-"};
inline constexpr Rule kStep{"step",
                            0.035,
                            "1/omega",
                            "longest step of the local linearisation; omega of the load",
                            "error below 1e-2 counts against RK4",
                            "-"};
inline constexpr Rule kStepMost{"step_most", 0.0125, "s", "longest step", "likewise", "-"};
inline constexpr Rule kRestStep{"rest_step", 0.004, "s", "longest step near rest", "likewise", "-"};
inline constexpr Rule kMostCorrelation{"most_correlation",
                                       1.5,
                                       "s",
                                       "of the unknown force; beyond it an offset would be noise",
                                       "correlation of wind and hands",
                                       "-"};
// Judgement.
inline constexpr Rule kBlock{"block",
                             2,
                             "s",
                             "independent piece of likelihood for sandwich and bootstrap",
                             "Kuensch, Ann. Statist. 17 (1989) 1217; > most_correlation",
                             "-"};
inline constexpr Rule kLeastBlocks{"least_blocks",
                                   30,
                                   "1",
                                   "blocks of all data; shorter ones where there is less data",
                                   "a bootstrap of fewer has no 1 % quantile",
                                   "-"};
inline constexpr Rule kFolds{
    "folds",
    5,
    "1",
    "folds of blocks of the cross-validation where there are fewer than least_runs runs",
    "Stone, JRSS B 36 (1974) 111",
    "-"};
inline constexpr Rule kLeftoverBeside{"leftover_beside",
                                      0.06,
                                      "1",
                                      "leftover gain over the gain of the named causes",
                                      "a term's form is not exactly the effect's",
                                      "-"};
inline constexpr Rule kDetection{
    "detection_level",
    0.01,
    "1",
    "level of the gain's block bootstrap, one-sided, over the number of candidates",
    "Kuensch 1989; Bonferroni",
    "1 % a stage"};
inline constexpr Rule kRivalLevel{"rival_level",
                                  0.05,
                                  "1",
                                  "a rival whose difference in likelihood covers 0 at this level",
                                  "Vuong, Econometrica 57 (1989) 307",
                                  "90 % interval"};
inline constexpr Rule kLeastEffect{
    "least_effect",
    0.03,
    "1",
    "share of the open-loop error in windows that a cause must remove in one column",
    "effect size beside significance",
    "-"};
inline constexpr Rule kLeastSecond{"least_second",
                                   0.02,
                                   "1",
                                   "gain of a further cause over the gain of those before",
                                   "a term's form is not exactly the effect's",
                                   "-"};
inline constexpr Rule kLeftoverLevel{"leftover_level",
                                     0.01,
                                     "1",
                                     "level of the largest leftover gain against sign flips of blocks",
                                     "Westfall, Young 1993, max-T",
                                     "1 % a data set"};
inline constexpr Rule kLeftoverShare{"leftover_share",
                                     0.15,
                                     "1",
                                     "share of the unknown force's variance that the leftover law explains",
                                     "effect size beside significance",
                                     "-"};
inline constexpr Rule kLeastRuns{"least_runs",
                                 4,
                                 "1",
                                 "runs for leave-one-run-out instead of folds of blocks",
                                 "Stone, JRSS B 36 (1974) 111",
                                 "-"};
// Sanity.
inline constexpr Rule kWindow{"window", 2, "s", "length of open-loop windows", "docs/diagnosis.md", "-"};
inline constexpr Rule kWorseWhole{
    "worse_whole",
    1.1,
    "1",
    "factor of the base's whole-run error that the extended model may not exceed",
    "friction integrates into position",
    "-"};
inline constexpr Rule kLeastMotion{
    "least_motion",
    0.1,
    "1",
    "share of the measured motion that the extended model must make over whole runs",
    "a model that stands still is no improvement",
    "-"};
inline constexpr Rule kGainLevel{
    "gain_level", 0.05, "1", "level of the held-out gain's interval", "percentile bootstrap over windows",
    "95 %"};
}  // namespace rule

inline constexpr std::array kRules{
    rule::kLeastRows,  rule::kBurnIn,      rule::kFloorShare,  rule::kStudent,        rule::kRestSpeed,
    rule::kRestBand,   rule::kStep,        rule::kStepMost,    rule::kRestStep,       rule::kMostCorrelation,
    rule::kBlock,      rule::kLeastBlocks, rule::kFolds,       rule::kLeftoverBeside, rule::kDetection,
    rule::kRivalLevel, rule::kLeastEffect, rule::kLeastSecond, rule::kLeftoverLevel,  rule::kLeftoverShare,
    rule::kLeastRuns,  rule::kWindow,      rule::kWorseWhole,  rule::kLeastMotion,    rule::kGainLevel};

}  // namespace crane::innovations
