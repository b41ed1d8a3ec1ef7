#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "truth/truth.hpp"

namespace truth {
namespace {

void append(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file{path, std::ios::binary};
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace

std::string csv(const Run& run) {
  std::string text;
  for (const std::string& column : run.columns) text += (text.empty() ? "" : ",") + column;
  text += '\n';
  for (const auto& row : run.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      append(text, row[i]);
    }
    text += '\n';
  }
  return text;
}

std::string answer_json(const Data& data) {
  using Json = nlohmann::ordered_json;
  Json effects = Json::array();
  for (const Found& found : data.answer) {
    Json parameters = Json::object();
    for (const Value& v : found.parameters) parameters[v.name] = {{"value", v.value}, {"unit", v.unit}};
    effects.push_back({{"name", found.name},
                       {"axis", found.axis},
                       {"amplitude", found.amplitude},
                       {"in_library", found.in_library},
                       {"form", found.form},
                       {"parameters", parameters}});
  }
  const Case& c = data.request;
  const Json json{{"rig", c.rig},
                  {"seed", c.seed},
                  {"training_runs", c.training_runs},
                  {"test_runs", c.test_runs},
                  {"disturbance", c.disturbance},
                  {"sensor_noise", c.sensor_noise},
                  {"effects", effects}};
  return json.dump(2) + "\n";
}

void write(const Data& data, const std::filesystem::path& directory) {
  std::error_code failed;
  std::filesystem::create_directories(directory, failed);
  if (failed) throw std::runtime_error(directory.string() + ": " + failed.message());
  for (const auto* runs : {&data.training, &data.test})
    for (const Run& run : *runs) write_file(directory / (run.file + ".csv"), csv(run));
  write_file(directory / "answer.json", answer_json(data));
}

}  // namespace truth
