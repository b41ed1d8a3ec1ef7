#include "recording_copy.hpp"

#include <algorithm>
#include <optional>

#include "crane/recording/schema.hpp"

namespace crane::recording {

bool have_equal_types(const SchemaRecord& a, const SchemaRecord& b) {
  if (a.encoding != b.encoding) return false;
  return a.encoding == "omgidl" ? define_equal_types(a.text, b.text) : a.text == b.text;
}

namespace {

bool same(const SchemaRecord& a, const SchemaRecord& b) { return a.name == b.name && have_equal_types(a, b); }

bool same(const ChannelRecord& a, const ChannelRecord& b) {
  return a.schema_id == b.schema_id && a.topic == b.topic && a.message_encoding == b.message_encoding &&
         a.metadata == b.metadata;
}

/// @return id of the record in `records`; nothing when there is none
template <class Record>
std::optional<std::uint16_t> id_of(const std::map<std::uint16_t, Record>& records, const Record& wanted) {
  for (const auto& [id, record] : records)
    if (same(record, wanted)) return id;
  return std::nullopt;
}

}  // namespace

RecordingCopy::RecordingCopy(const std::filesystem::path& file,
                             std::span<const std::filesystem::path> sources)
    : file_{file, sources}, writer_{file_.partial()} {}

RecordingCopy::ChannelIds RecordingCopy::add_channels(const McapReader& source) {
  ChannelIds schema_ids{{std::uint16_t{0}, std::uint16_t{0}}};
  for (const SchemaRecord& schema : source.schemas()) {
    auto id = id_of(schemas_, schema);
    if (!id) id = writer_.schema(schema.name, schema.encoding, schema.text);
    schemas_.try_emplace(*id, schema);
    schema_ids[schema.id] = *id;
  }
  ChannelIds channel_ids;
  for (ChannelRecord channel : source.channels()) {
    const auto original = channel.id;
    channel.schema_id = schema_ids[channel.schema_id];
    auto id = id_of(channels_, channel);
    if (!id)
      id = writer_.channel(channel.schema_id, channel.topic, channel.message_encoding, channel.metadata);
    channels_.try_emplace(*id, channel);
    channel_ids[original] = *id;
  }
  return channel_ids;
}

void RecordingCopy::add_attachments(McapReader& source) {
  for (const auto& record : source.metadata()) {
    const bool known = std::ranges::any_of(metadata_, [&](const MetadataRecord& other) {
      return other.name == record.name && other.entries == record.entries;
    });
    if (known) continue;
    writer_.metadata(record.name, record.entries);
    metadata_.push_back(record);
  }
  for (auto& each : source.attachments()) {
    const bool known = std::ranges::any_of(attachments_, [&](const AttachmentRecord& other) {
      return other.name == each.name && other.media_type == each.media_type && other.data == each.data;
    });
    if (known) continue;
    writer_.attachment(each.name, each.media_type, each.time_ns, each.data);
    attachments_.push_back(std::move(each));
  }
}

void RecordingCopy::add_metadata(const std::string& name, const Metadata& entries) {
  writer_.metadata(name, entries);
}

void RecordingCopy::add(const Message& message, const ChannelIds& channels) {
  writer_.message(channels.at(message.channel->id), message.sequence, message.log_time_ns,
                  message.publish_time_ns, message.data);
}

std::uint64_t RecordingCopy::finish() {
  writer_.close();
  file_.publish();
  return writer_.message_count();
}

}  // namespace crane::recording
