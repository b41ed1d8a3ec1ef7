#pragma once
/// Converts samples to JSON with the IDL text; enums become their names.
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "crane/bus/cdr.hpp"
#include "crane/recording/schema.hpp"

namespace crane::cli {

/// All types of crane.idl.
[[nodiscard]] const recording::Schema& schema();

/// @param name  "crane/state" or "state". @return nullptr when no topic has this name
[[nodiscard]] const topics::Description* find_topic(std::string_view name);
/// find_topic() for a command line. @throws CLI::ValidationError with the list of topics
[[nodiscard]] const topics::Description& topic_named(std::string_view name);

[[nodiscard]] nlohmann::ordered_json to_json(const topics::Description& topic, const void* sample);

template <class T>
[[nodiscard]] nlohmann::ordered_json to_json(const topics::Topic<T>& topic, const T& sample) {
  return to_json(topic.description, static_cast<const void*>(&sample));
}

/// @return true when `leaf` is `path` ("header.tick", "applied_v[0]") or a part of it ("header", "axis[1]"),
///   and for an empty path
[[nodiscard]] bool is_below(std::string_view leaf, std::string_view path);
[[nodiscard]] std::vector<recording::Leaf> leaves_below(const nlohmann::ordered_json& sample,
                                                        std::string_view path);

/// Text of a value: numbers in the shortest form that reads back, strings without quotes.
[[nodiscard]] std::string text_of(const nlohmann::ordered_json& leaf);

}  // namespace crane::cli
