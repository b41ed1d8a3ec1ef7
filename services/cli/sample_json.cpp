#include "cli/sample_json.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "crane/recording/csv.hpp"

namespace crane::cli {

const recording::Schema& schema() {
  static const recording::Schema all{topics::idl_text()};
  return all;
}

const topics::Description* find_topic(std::string_view name) {
  constexpr std::string_view kPrefix = "crane/";
  const auto* const found = std::find_if(topics::kAll.begin(), topics::kAll.end(), [&](const auto& topic) {
    return topic.name == name || topic.name.substr(kPrefix.size()) == name;
  });
  return found == topics::kAll.end() ? nullptr : found;
}

const topics::Description& topic_named(std::string_view name) {
  if (const auto* topic = find_topic(name)) return *topic;
  std::string known;
  for (const auto& topic : topics::kAll) known += (known.empty() ? "" : ", ") + std::string{topic.name};
  throw CLI::ValidationError("topic",
                             "no topic has the name '" + std::string{name} + "'; the topics are " + known);
}

nlohmann::ordered_json to_json(const topics::Description& topic, const void* sample) {
  constexpr std::array<std::uint8_t, 4> kPlainLittleEndian{0, 1, 0, 0};
  const auto& codec = bus::CdrCodec::of(*topic.descriptor);
  std::vector<std::uint8_t> bytes(kPlainLittleEndian.size() + codec.max_encoded_bytes());
  std::copy(kPlainLittleEndian.begin(), kPlainLittleEndian.end(), bytes.begin());
  bytes.resize(kPlainLittleEndian.size() +
               codec.encode(sample, std::span{bytes}.subspan(kPlainLittleEndian.size())));
  return schema().decode(topic.type, bytes);
}

bool is_below(std::string_view leaf, std::string_view path) {
  if (path.empty() || leaf == path) return true;
  return leaf.starts_with(path) && (leaf[path.size()] == '.' || leaf[path.size()] == '[');
}

std::vector<recording::Leaf> leaves_below(const nlohmann::ordered_json& sample, std::string_view path) {
  auto leaves = recording::flatten(sample);
  std::erase_if(leaves, [path](const recording::Leaf& leaf) { return !is_below(leaf.first, path); });
  return leaves;
}

std::string text_of(const nlohmann::ordered_json& leaf) {
  if (leaf.is_string()) return leaf.get<std::string>();
  if (leaf.is_number_float()) return recording::shortest(leaf.get<double>());
  if (leaf.is_null()) return "nan";
  return leaf.dump();
}

}  // namespace crane::cli
