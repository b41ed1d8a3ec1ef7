#pragma once
/// Recordings as CSV and as JSON lines, and what is in them.
#include <filesystem>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>

#include "crane/recording/mcap_reader.hpp"

namespace crane::cli {

/// One topic: log_time_ns, publish_time_ns, then every leaf of its type; text quoted where CSV asks for it,
/// true 1, false 0. @throws std::runtime_error when the recording has no such topic, or a type that cannot be
/// decoded
void write_topic_csv(std::ostream& out, recording::McapReader& recording, const std::string& topic);

/// One JSON object a line: topic, log_time_ns, publish_time_ns, data. @param topic  empty: all that can be
/// decoded
void write_json_lines(std::ostream& out, recording::McapReader& recording, const std::string& topic);

/// {"file", "bytes", "indexed", "first_time_ns", "last_time_ns", "duration_s", "messages", "topics": [...],
///  "metadata": [...], "attachments": [...], "problems": [...]}
[[nodiscard]] nlohmann::ordered_json describe(recording::McapReader& recording,
                                              const std::filesystem::path& file);

/// A cell of a CSV file. (RFC 4180)
[[nodiscard]] std::string csv_cell(const nlohmann::ordered_json& leaf);

}  // namespace crane::cli
