#pragma once
/// Samples as JSON, by the IDL text: numbers as numbers, enums by name.
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "crane/bus/cdr.hpp"
#include "crane/recording/schema.hpp"

namespace crane::cli {

/// All types of crane.idl.
[[nodiscard]] const recording::Schema& schema();

/// "crane/state" or "state". @return nullptr when there is no such topic
[[nodiscard]] const topics::Description* find_topic(std::string_view name);
/// The same for a command line. @throws CLI::ValidationError listing the topics there are
[[nodiscard]] const topics::Description& topic_named(std::string_view name);

[[nodiscard]] nlohmann::ordered_json to_json(const topics::Description& topic, const void* sample);

template <class T>
[[nodiscard]] nlohmann::ordered_json to_json(const topics::Topic<T>& topic, const T& sample) {
  return to_json(topic.description, static_cast<const void*>(&sample));
}

/// Whether the leaf is `path` itself ("header.tick", "applied_v[0]") or below it ("header", "axis[1]"). Empty
/// path: always.
[[nodiscard]] bool is_below(std::string_view leaf, std::string_view path);
[[nodiscard]] std::vector<recording::Leaf> leaves_below(const nlohmann::ordered_json& sample,
                                                        std::string_view path);

/// As a person or a CSV cell wants it: numbers in the shortest form that reads back, strings without quotes.
[[nodiscard]] std::string text_of(const nlohmann::ordered_json& leaf);

}  // namespace crane::cli
