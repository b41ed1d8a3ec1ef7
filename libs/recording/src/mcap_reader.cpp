#include "crane/recording/mcap_reader.hpp"

#include <algorithm>

#include "mcap_format.hpp"
#include "mcap_reader_state.hpp"

namespace crane::recording {

using mcap::Cursor;
using mcap::FormatError;

McapReader::McapReader(const std::filesystem::path& recording) : state_{std::make_unique<State>(recording)} {
  state_->open();
}
McapReader::~McapReader() = default;
McapReader::McapReader(McapReader&&) noexcept = default;
McapReader& McapReader::operator=(McapReader&&) noexcept = default;

const std::vector<std::filesystem::path>& McapReader::files() const { return state_->names; }
const std::vector<SchemaRecord>& McapReader::schemas() const { return state_->schemas; }
const std::vector<ChannelRecord>& McapReader::channels() const { return state_->channels; }
bool McapReader::indexed() const { return state_->indexed; }
const std::vector<std::string>& McapReader::problems() const { return state_->problems; }

const SchemaRecord* McapReader::find_schema(std::uint16_t id) const {
  for (const SchemaRecord& schema : state_->schemas)
    if (schema.id == id) return &schema;
  return nullptr;
}

std::int64_t McapReader::first_time_ns() const {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  for (const ChunkPlace& chunk : state_->contents.chunks)
    if (chunk.has_messages) first = std::min(first, chunk.first_ns);
  return first == std::numeric_limits<std::int64_t>::max() ? 0 : first;
}

std::int64_t McapReader::last_time_ns() const {
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  for (const ChunkPlace& chunk : state_->contents.chunks)
    if (chunk.has_messages) last = std::max(last, chunk.last_ns);
  return last == std::numeric_limits<std::int64_t>::min() ? 0 : last;
}

std::vector<MetadataRecord> McapReader::metadata() {
  std::vector<MetadataRecord> list;
  for (const Place& place : state_->contents.metadata) try {
      list.push_back(state_->metadata_at(place));
    } catch (const FormatError& error) {
      state_->report(place, std::string{"metadata are damaged and skipped: "} + error.what());
    }
  return list;
}

std::vector<AttachmentRecord> McapReader::attachments() {
  std::vector<AttachmentRecord> list;
  for (const Place& place : state_->contents.attachments) try {
      const std::string content = state_->content_of(place);
      Cursor cursor{content};
      AttachmentRecord attachment;
      attachment.time_ns = cursor.time();
      (void)cursor.time();
      attachment.name = fields::printable(cursor.text());
      attachment.media_type = cursor.text();
      const Bytes data = as_bytes(cursor.raw(cursor.number<std::uint64_t>()));
      attachment.data.assign(data.begin(), data.end());
      const std::size_t covered = content.size() - cursor.rest().size();
      const auto crc = cursor.number<std::uint32_t>();
      if (crc != 0 && crc != mcap::crc32(content.data(), covered)) throw FormatError("CRC is wrong");
      list.push_back(std::move(attachment));
    } catch (const FormatError& error) {
      state_->report(place, std::string{"attachment is damaged and skipped: "} + error.what());
    }
  return list;
}

}  // namespace crane::recording
