#pragma once
/// Exports recordings as CSV and JSON lines, and describes their content.
#include <filesystem>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crane/recording/loss.hpp"
#include "crane/recording/mcap_reader.hpp"

namespace crane::cli {

/// Full name of a recorded topic: "crane/state" for "state". @throws std::runtime_error with the recorded
/// topics
[[nodiscard]] std::string recorded_topic(const recording::McapReader& recording, const std::string& topic);

/// Writes one topic: log_time_ns, publish_time_ns, then every elementary value of its type. Booleans are 1
/// and 0.
/// @throws std::runtime_error when the recording has no such topic, or its type cannot be decoded
void write_topic_csv(std::ostream& out, recording::McapReader& recording, const std::string& topic);

/// Writes one JSON object per line: topic, log_time_ns, publish_time_ns, data.
/// @param topic  empty: all topics that can be decoded
void write_json_lines(std::ostream& out, recording::McapReader& recording, const std::string& topic);

/// {"file", "bytes", "indexed", "first_time_ns", "last_time_ns", "duration_s", "messages", "topics": [...],
///  "metadata": [...], "attachments": [...], "problems": [...], "files": [...], "losses": [...]}
/// "losses" is missing in a recording that does not account for them.
[[nodiscard]] nlohmann::ordered_json describe(recording::McapReader& recording,
                                              const std::filesystem::path& file);

/// [{"topic", "cause", "samples", "from_ns", "until_ns"}, ...]
[[nodiscard]] nlohmann::ordered_json losses_json(const std::vector<recording::Loss>& losses);

/// A cell of a CSV file (RFC 4180).
[[nodiscard]] std::string csv_cell(const nlohmann::ordered_json& leaf);

}  // namespace crane::cli
