#include <system_error>

#include "crane/recording/mcap_reader.hpp"

namespace crane::recording {
namespace {

void copy_messages(McapReader& reader, McapWriter& writer, CheckReport& report) {
  std::map<std::uint16_t, std::uint16_t> schema_ids{{std::uint16_t{0}, std::uint16_t{0}}};
  for (const SchemaRecord& schema : reader.schemas())
    schema_ids[schema.id] = writer.schema(schema.name, schema.encoding, schema.text);
  std::map<std::uint16_t, std::uint16_t> channel_ids;
  for (const ChannelRecord& channel : reader.channels())
    channel_ids[channel.id] = writer.channel(schema_ids[channel.schema_id], channel.topic,
                                             channel.message_encoding, channel.metadata);
  reader.for_each({}, [&](const Message& message) {
    writer.message(channel_ids[message.channel->id], message.sequence, message.log_time_ns,
                   message.publish_time_ns, message.data);
    ++report.messages;
    return true;
  });
}

}  // namespace

CheckReport check(const std::filesystem::path& file) {
  McapReader reader{file};
  CheckReport report;
  reader.for_each({}, [&](const Message&) {
    ++report.messages;
    return true;
  });
  (void)reader.metadata();
  (void)reader.attachments();
  report.problems = reader.problems();
  return report;
}

CheckReport repair(const std::filesystem::path& damaged, const std::filesystem::path& repaired) {
  McapReader reader{damaged};
  std::error_code ignored;
  if (std::filesystem::equivalent(damaged, repaired, ignored))
    throw WriteError(repaired.string() + ": is the damaged file itself; give another name");
  const std::filesystem::path partial = repaired.string() + ".partial";
  CheckReport report;
  try {
    McapWriter writer{partial};
    copy_messages(reader, writer, report);
    for (const MetadataRecord& each : reader.metadata()) writer.metadata(each.name, each.entries);
    for (const AttachmentRecord& each : reader.attachments())
      writer.attachment(each.name, each.media_type, each.time_ns, each.data);
    writer.close();
  } catch (...) {
    std::filesystem::remove(partial, ignored);
    throw;
  }
  std::error_code failure;
  std::filesystem::rename(partial, repaired, failure);
  if (failure)
    throw WriteError(repaired.string() + ": cannot rename " + partial.string() + ": " + failure.message());
  report.problems = reader.problems();
  return report;
}

}  // namespace crane::recording
