#include "cli/diagnosis_data.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "crane/recording/run_table.hpp"

namespace crane::cli {
namespace {

using diagnosis::DataError;
namespace fs = std::filesystem;

/// Reads the files and collects the problems of each.
class DataReader {
 public:
  DataReader(const diagnosis::Mapping& mapping, const configuration::Rig& rig)
      : mapping_(mapping), rig_(rig) {}

  std::vector<diagnosis::Run> read(const std::vector<std::string>& files) {
    std::vector<diagnosis::Run> runs;
    for (const std::string& file : files) {
      std::error_code none;
      if (!seen_.insert(fs::weakly_canonical(file, none)).second)
        problems_.push_back(file + ": is given twice; use each run either for training or for the test");
      try {
        diagnosis::Loaded loaded = load(file);
        notes_.insert(notes_.end(), loaded.notes.begin(), loaded.notes.end());
        std::move(loaded.runs.begin(), loaded.runs.end(), std::back_inserter(runs));
      } catch (const DataError& error) {
        problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
      } catch (const std::runtime_error& error) {  // exceptions of the readers name the file or its content
        const std::string what = error.what();
        problems_.push_back(what.find(file) == std::string::npos ? file + ": " + what : what);
      }
    }
    return runs;
  }

  void finish() const {
    if (!problems_.empty()) throw DataError(problems_);
  }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  diagnosis::Loaded load(const std::string& file) {
    if (fs::path{file}.extension() != ".mcap")
      return diagnosis::load_run(
          diagnosis::canonical(under_control(recording::read_csv(file)), mapping_, file), rig_, file);
    recording::McapReader recording{file};
    diagnosis::Mapping rows_only;
    rows_only.whole = mapping_.whole;
    const auto table = diagnosis::canonical(under_control(recording::run_table(recording)), rows_only, file);
    for (const std::string& problem : recording.problems()) notes_.push_back(problem);
    return diagnosis::load_run(table, rig_, file);
  }

  const diagnosis::Mapping& mapping_;
  const configuration::Rig& rig_;
  std::set<fs::path> seen_;
  std::vector<std::string> problems_, notes_;
};

}  // namespace

recording::Table under_control(recording::Table table) {
  const auto* state = table.find("supervisor_state");
  if (state == nullptr) return table;
  const std::vector<double> states = *state;
  constexpr double kHold = static_cast<int>(crane_STATE_HOLD), kRun = static_cast<int>(crane_STATE_RUN);
  const auto moves = [](double s) { return s == kHold || s == kRun; };
  if (std::none_of(states.begin(), states.end(), [](double s) { return std::isfinite(s); })) return table;
  for (auto& column : table.columns) {
    std::vector<double> kept;
    for (std::size_t k = 0; k < states.size(); ++k)
      if (moves(states[k])) kept.push_back(column.values[k]);
    column.values = std::move(kept);
  }
  return table;
}

DiagnosisData read_diagnosis_data(const std::vector<std::string>& train, const std::vector<std::string>& test,
                                  const diagnosis::Mapping& mapping, const configuration::Rig& rig) {
  DataReader reader{mapping, rig};
  DiagnosisData data;
  data.train = reader.read(train);
  data.test = reader.read(test);
  reader.finish();
  data.notes = reader.notes();
  return data;
}

}  // namespace crane::cli
