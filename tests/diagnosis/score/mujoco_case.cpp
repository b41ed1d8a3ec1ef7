#include "score/mujoco_case.hpp"

#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "crane/configuration/rig.hpp"
#include "crane/diagnosis/mapping.hpp"
#include "write.hpp"

namespace crane::diagnosis::score {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Owner of a temporary directory.
class Folder {
 public:
  Folder() : path_((fs::temp_directory_path() / "crane_mujoco_XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw std::runtime_error(path_ + ": cannot be made");
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] fs::path path() const { return path_; }

 private:
  std::string path_;
};

std::vector<Run> runs_in(const fs::path& folder, const std::string& prefix, const configuration::Rig& rig) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".csv" && entry.path().filename().string().starts_with(prefix))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Run> runs;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    recording::Table table = recording::read_csv(file);
    if (fs::exists(folder / "mapping.toml"))
      table = canonical(table, load_mapping(folder / "mapping.toml"), name);
    for (Run& piece : load_run(table, rig, name).runs) runs.push_back(std::move(piece));
  }
  return runs;
}

std::vector<HiddenEffect> answer_in(const Json& truth) {
  std::vector<HiddenEffect> hidden;
  for (const Json& effect : truth.at("effects"))
    hidden.push_back({effect.at("name"), effect.at("axis"), effect.at("in_library"),
                      effect.at("parameters").get<std::map<std::string, double>>()});
  return hidden;
}

/// The answer has the library's names. Phases and positions of periodic effects are not compared.
std::vector<Compared> compared_by_name(const Diagnosis& found, const std::vector<HiddenEffect>& answer) {
  std::vector<Compared> all;
  for (const HiddenEffect& hidden : answer)
    for (const Cause& cause : found.causes)
      if (cause.name == hidden.name &&
          (cause.axis.empty() || hidden.axis.empty() || cause.axis == hidden.axis))
        for (const Estimate& e : cause.parameters)
          if (const auto truth = hidden.parameters.find(e.name);
              truth != hidden.parameters.end() && e.name != "phase_rad" && e.name != "tight_at")
            all.push_back({cause.name, e.name, truth->second, e.value, e.std_dev});
  return all;
}

std::map<std::string, double> nuisance_in(const Json& truth) {
  std::map<std::string, double> all{{"swing_deg", truth.at("swing_deg")}};
  for (const auto& [name, value] : truth.at("nuisance").items())
    if (value.is_number()) all[name] = value;
  return all;
}

}  // namespace

std::string kind_of_mujoco(std::size_t number) {
  return mujoco_truth::name_of(mujoco_truth::kind_of_set(number));
}

Record scored_mujoco(std::size_t number, std::uint64_t deck_seed) {
  const Folder folder;
  const fs::path truth_file = folder.path() / "answer" / "truth.json";
  mujoco_truth::write(mujoco_truth::made({"bench", deck_seed}, number, false), folder.path(), truth_file);
  Record record;
  record.deck = "mujoco";
  record.number = number;
  record.seed = deck_seed;
  const configuration::Rig rig = configuration::load_rig((folder.path() / "rig.toml").string());
  const std::vector<Run> train = runs_in(folder.path(), "train_", rig);
  for (const Run& run : train) record.data_s += run.duration_s();
  const Diagnosis found = diagnose(rig, train, runs_in(folder.path(), "test_", rig));

  const Json truth = Json::parse(std::ifstream{truth_file});
  const std::vector<HiddenEffect> answer = answer_in(truth);
  record.kind = truth.at("kind");
  record.rig = truth.at("rig_kind");
  record.hidden = labels_of(answer);
  for (const HiddenEffect& effect : answer) record.causes.push_back(effect.name);
  if (!answer.empty()) {
    record.multiple = truth["effects"][0].at("wanted_size");
    record.amplitude = truth["effects"][0].at("size");
  }
  record.judged = name_of(judge(found, answer));
  record.verdict = diagnosis::name_of(found.verdict);
  record.found = found_in(found);
  record.gain = found.held_out.gain;
  record.runtime_s = found.runtime_s;
  record.estimates = compared_by_name(found, answer);
  record.nuisance = nuisance_in(truth);
  record.peak_mb = peak_mb();
  return record;
}

}  // namespace crane::diagnosis::score
