#include "score/sealed_case.hpp"

#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace crane::diagnosis::score {
namespace {

namespace fs = std::filesystem;

fs::path new_directory() {
  std::string name = (fs::temp_directory_path() / "crane_sealed_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
  return name;
}

std::vector<Run> runs_in(const fs::path& directory, const std::string& prefix,
                         const configuration::Rig& rig) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.path().extension() == ".csv" && entry.path().filename().string().starts_with(prefix))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Run> runs;
  for (const fs::path& file : files)
    for (Run& piece : load_run(recording::read_csv(file), rig, file.filename().string()).runs)
      runs.push_back(std::move(piece));
  return runs;
}

}  // namespace

SealedCase::SealedCase(const truth::Case& request) : rig_(request.rig), directory_(new_directory()) {
  try {
    truth::write(truth::generate(request), directory_);
  } catch (...) {
    fs::remove_all(directory_);
    throw;
  }
}

SealedCase::~SealedCase() {
  std::error_code ignored;
  fs::remove_all(directory_, ignored);
}

Diagnosis SealedCase::diagnosed(const Request& request) const {
  const configuration::Rig rig = rig_file_of(rig_);
  return diagnose(rig, runs_in(directory_, "train_", rig), runs_in(directory_, "test_", rig), request);
}

std::vector<HiddenEffect> SealedCase::answer() const {
  std::ifstream file{directory_ / "answer.json"};
  const auto json = nlohmann::json::parse(file);
  std::vector<HiddenEffect> hidden;
  for (const auto& effect : json.at("effects")) {
    if (effect.at("amplitude").get<double>() == 0) continue;
    HiddenEffect h{effect.at("name"), effect.at("axis"), effect.at("in_library"), {}};
    for (const auto& [name, value] : effect.at("parameters").items())
      h.parameters[name] = value.at("value").get<double>();
    hidden.push_back(std::move(h));
  }
  return hidden;
}

configuration::Rig rig_file_of(const std::string& truth_rig) {
  const std::string name = truth_rig == "tower" ? "virginia_tech_tower" : truth_rig;
  return configuration::load_rig(std::string{CRANE_RIGS} + "/" + name + ".toml");
}

}  // namespace crane::diagnosis::score
