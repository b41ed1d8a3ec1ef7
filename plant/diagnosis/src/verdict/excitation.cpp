#include "verdict/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "crane/diagnosis/kinematics.hpp"
#include "replay/standstill.hpp"

namespace crane::diagnosis {
namespace {

double total_s(const Runs& runs) {
  double sum = 0;
  for (const PreparedRun& run : runs) sum += run.run.duration_s();
  return sum;
}

/// "training data (a.csv, b.csv)"
std::string called(const std::string& what, const Runs& runs) {
  std::string names;
  for (const PreparedRun& run : runs)
    if (names.find(run.run.name) == std::string::npos) names += (names.empty() ? "" : ", ") + run.run.name;
  return what + (names.empty() ? "" : " (" + names + ")");
}

/// Problems of runs with too little motion.
void add_problems(const std::string& what, const Runs& runs, double least_s, const configuration::Rig& rig,
                  std::vector<std::string>& problems) {
  constexpr double kLeastRate = 0.01, kLeastTravel = 0.005;
  if (total_s(runs) < least_s)
    problems.push_back((std::ostringstream{} << called(what, runs) << ": " << total_s(runs)
                                             << " s in total: at least " << least_s << " s are required")
                           .str());
  bool moves = false;
  for (const PreparedRun& run : runs)
    for (const Motion& motion : run.motion) {
      if (motion.position.empty()) continue;
      const auto [low, high] = std::minmax_element(motion.position.begin(), motion.position.end());
      double fastest = 0;
      for (const double rate : motion.rate) fastest = std::max(fastest, std::abs(rate));
      moves = moves || (fastest > kLeastRate && *high - *low > kLeastTravel);
    }
  if (!moves)
    problems.push_back((std::ostringstream{} << called(what, runs) << ": no axis or swing of " << rig.name
                                             << " moves by more than " << kLeastTravel
                                             << " m or rad and faster than " << kLeastRate
                                             << " m/s or rad/s: record a motion")
                           .str());
}

/// All runs must have the same measured columns and commands, because they are compared together.
void require_same_columns(const Runs& train, const Runs& test) {
  std::vector<std::string> problems;
  const Run& first = train.at(0).run;
  for (const Runs* runs : {&train, &test})
    for (const PreparedRun& prepared : *runs) {
      const Run& run = prepared.run;
      for (const Output output : kAllOutputs) {
        const bool drive = output == kTrolleyPosition || output == kSlewAngle;
        if (run.has(output) != first.has(output))
          problems.push_back((run.has(output) ? first : run).name + ": " + kOutputNames[output] +
                             ": missing: all runs need the same columns, and " +
                             (run.has(output) ? run : first).name + " has this column");
        else if (drive && run.has(output) && run.commanded[output] != first.commanded[output])
          problems.push_back((run.commanded[output] ? first : run).name + ": command of the " +
                             axis_of(output) + ": missing: all runs need the same commands, and " +
                             (run.commanded[output] ? run : first).name + " has this command");
      }
    }
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  if (!problems.empty()) throw DataError(problems);
}

}  // namespace

Runs prepared(std::vector<Run> runs, const configuration::Rig& rig, const Accuracy& accuracy) {
  Runs all;
  for (Run& run : runs) all.push_back(prepare(std::move(run), rig, accuracy));
  return all;
}

void hold_resting_drives(Runs& train, Runs& test) {
  constexpr double kLeastMoving_s = 0.15;  // of a piece between two rests (shooting/pieces.cpp)
  for (const Output drive : {kTrolleyPosition, kSlewAngle}) {
    const auto moves = [drive](const PreparedRun& run) {
      const std::vector<double>& rate = run.motion[drive].rate;
      const auto rows = std::ranges::count_if(rate, [](double v) { return std::abs(v) >= kStandstillSpeed; });
      return static_cast<double>(rows) * run.run.period_s >= kLeastMoving_s;
    };
    if (std::ranges::any_of(train, moves)) continue;
    for (Runs* runs : {&train, &test})
      for (PreparedRun& run : *runs) run.run.commanded[drive] = false;
  }
}

void require_excitation(const Runs& train, const Runs& test, const configuration::Rig& rig) {
  constexpr double kLeastTraining_s = 8, kLeastHeldOut_s = 4;
  if (train.empty()) throw DataError({"training data: no run"});
  require_same_columns(train, test);
  std::vector<std::string> problems;
  add_problems("training data", train, kLeastTraining_s, rig, problems);
  if (!test.empty()) add_problems("held-out data", test, kLeastHeldOut_s, rig, problems);
  if (!problems.empty()) throw DataError(problems);
}

}  // namespace crane::diagnosis
