#pragma once
/// Prepared runs of the truth.
#include "score/sealed_case.hpp"
#include "study/study.hpp"
#include "truth/truth.hpp"

namespace crane::diagnosis {

[[nodiscard]] inline Runs runs_of(const std::vector<truth::Run>& runs, const configuration::Rig& rig) {
  Runs all;
  for (const truth::Run& run : runs)
    for (Run& piece : load_run(recording::parse_csv(truth::csv(run), run.file), rig, run.file).runs)
      all.push_back(prepare(std::move(piece), rig));
  return all;
}

struct DataOfTruth {
  explicit DataOfTruth(const truth::Case& request) : DataOfTruth(request, truth::generate(request)) {}

  configuration::Rig rig;
  Runs train, test;

 private:
  DataOfTruth(const truth::Case& request, const truth::Data& data)
      : rig(score::rig_file_of(request.rig)),
        train(runs_of(data.training, rig)),
        test(runs_of(data.test, rig)) {}
};

}  // namespace crane::diagnosis
