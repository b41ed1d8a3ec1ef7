#include "cli/log_export.hpp"

#include <map>
#include <ostream>

#include "cli/sample_json.hpp"
#include "crane/recording/run_table.hpp"

namespace crane::cli {
namespace {

using nlohmann::ordered_json;

/// Types according to the IDL text of the recording.
class Decoder {
 public:
  explicit Decoder(const recording::McapReader& recording) : recording_{recording} {}

  [[nodiscard]] ordered_json decode(const recording::Message& message) {
    const auto& schema = schema_of(*message.channel);
    return schema.decode(recording_.find_schema(message.channel->schema_id)->name, message.data);
  }
  [[nodiscard]] std::vector<std::string> columns(const recording::ChannelRecord& channel) {
    const auto& schema = schema_of(channel);
    return schema.columns(recording_.find_schema(channel.schema_id)->name);
  }
  [[nodiscard]] bool understands(const recording::ChannelRecord& channel) const {
    const auto* schema = recording_.find_schema(channel.schema_id);
    return channel.message_encoding == "cdr" && schema != nullptr && schema->encoding == "omgidl";
  }

 private:
  const recording::Schema& schema_of(const recording::ChannelRecord& channel) {
    if (!understands(channel))
      throw std::runtime_error("topic " + channel.topic +
                               ": not CDR with an IDL schema, so it cannot be decoded");
    const auto found = schemas_.find(channel.schema_id);
    if (found != schemas_.end()) return found->second;
    return schemas_
        .emplace(channel.schema_id, recording::Schema{recording_.find_schema(channel.schema_id)->text})
        .first->second;
  }

  const recording::McapReader& recording_;
  std::map<std::uint16_t, recording::Schema> schemas_;
};

/// Finds a recorded topic by "crane/state" or "state".
const recording::ChannelRecord& channel_of(const recording::McapReader& recording, const std::string& topic) {
  std::string known;
  for (const auto& channel : recording.channels()) {
    if (channel.topic == topic || channel.topic == "crane/" + topic) return channel;
    known += (known.empty() ? "" : ", ") + channel.topic;
  }
  throw std::runtime_error("the recording has no topic '" + topic + "'; it has " +
                           (known.empty() ? "none" : known));
}

}  // namespace

std::string csv_cell(const ordered_json& leaf) {
  if (leaf.is_boolean()) return leaf.get<bool>() ? "1" : "0";
  const auto text = text_of(leaf);
  if (!leaf.is_string() || text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string{"\"\""} : std::string{c};
  return quoted + '"';
}

std::string recorded_topic(const recording::McapReader& recording, const std::string& topic) {
  return channel_of(recording, topic).topic;
}

void write_topic_csv(std::ostream& out, recording::McapReader& recording, const std::string& topic) {
  Decoder decoder{recording};
  const auto& channel = channel_of(recording, topic);
  out << "log_time_ns,publish_time_ns";
  for (const auto& column : decoder.columns(channel)) out << ',' << column;
  out << '\n';
  recording.for_each({.topics = {channel.topic}}, [&](const recording::Message& message) {
    out << message.log_time_ns << ',' << message.publish_time_ns;
    for (const auto& leaf : recording::flatten(decoder.decode(message))) out << ',' << csv_cell(leaf.second);
    out << '\n';
    return true;
  });
}

void write_json_lines(std::ostream& out, recording::McapReader& recording, const std::string& topic) {
  Decoder decoder{recording};
  recording::Selection selection;
  if (!topic.empty()) selection.topics = {channel_of(recording, topic).topic};
  recording.for_each(selection, [&](const recording::Message& message) {
    if (topic.empty() && !decoder.understands(*message.channel)) return true;
    const ordered_json line{{"topic", message.channel->topic},
                            {"log_time_ns", message.log_time_ns},
                            {"publish_time_ns", message.publish_time_ns},
                            {"data", decoder.decode(message)}};
    out << line.dump() << '\n';
    return true;
  });
}

ordered_json losses_json(const std::vector<recording::Loss>& losses) {
  auto list = ordered_json::array();
  for (const auto& loss : losses)
    list.push_back({{"topic", loss.topic},
                    {"cause", recording::to_string(loss.cause)},
                    {"samples", loss.samples},
                    {"from_ns", loss.from_ns},
                    {"until_ns", loss.until_ns}});
  return list;
}

ordered_json describe(recording::McapReader& recording, const std::filesystem::path& file) {
  std::map<std::uint16_t, std::uint64_t> counts;
  std::uint64_t messages = 0;
  recording.for_each({}, [&](const recording::Message& message) {
    ++counts[message.channel->id];
    ++messages;
    return true;
  });
  const double duration_s = static_cast<double>(recording.last_time_ns() - recording.first_time_ns()) * 1e-9;
  std::uintmax_t bytes = 0;
  for (const auto& each : recording.files()) bytes += std::filesystem::file_size(each);
  const bool accounted = recording::has_losses_channel(recording);
  const auto losses = recording::losses_in(recording);
  std::map<std::string, std::uint64_t> missing;
  for (const auto& loss : losses) missing[loss.topic] += loss.samples;
  ordered_json result{{"file", file.string()},
                      {"bytes", bytes},
                      {"indexed", recording.indexed()},
                      {"first_time_ns", recording.first_time_ns()},
                      {"last_time_ns", recording.last_time_ns()},
                      {"duration_s", duration_s},
                      {"messages", messages}};
  if (const auto version = recording::messages_version(recording)) result["messages_version"] = *version;
  result["topics"] = ordered_json::array();
  for (const auto& channel : recording.channels()) {
    const auto* schema = recording.find_schema(channel.schema_id);
    result["topics"].push_back({{"topic", channel.topic},
                                {"type", schema != nullptr ? schema->name : ""},
                                {"messages", counts[channel.id]}});
    if (accounted) result["topics"].back()["missing"] = missing[channel.topic];
  }
  result["metadata"] = ordered_json::array();
  for (const auto& record : recording.metadata())
    result["metadata"].push_back({{"name", record.name}, {"entries", record.entries}});
  result["attachments"] = ordered_json::array();
  for (const auto& attachment : recording.attachments())
    result["attachments"].push_back({{"name", attachment.name}, {"bytes", attachment.data.size()}});
  result["problems"] = recording.problems();
  result["files"] = ordered_json::array();
  for (const auto& each : recording.files()) result["files"].push_back(each.string());
  if (accounted) result["losses"] = losses_json(losses);
  return result;
}

}  // namespace crane::cli
