#include "mcap_contents.hpp"

#include <zstd.h>

#include <algorithm>

#include "mcap_format.hpp"

namespace crane::recording {
namespace {

using mcap::Cursor;
using mcap::FormatError;
using mcap::Op;

/// Maximum size of an unpacked chunk, bytes: 64 times the size at which McapWriter closes a chunk. The limit
/// bounds memory and time: 32 kB of a file can unpack to 1 GiB.
constexpr std::uint64_t kMaxChunk = 1ULL << 26U;

ChunkPlace read_chunk_index(Cursor content) {
  ChunkPlace chunk;
  chunk.first_ns = content.time();
  chunk.last_ns = content.time();
  chunk.place.offset = content.number<std::uint64_t>();
  chunk.place.length = content.number<std::uint64_t>();
  chunk.has_messages = !content.text().empty();
  return chunk;
}

Place read_place(Cursor content) {
  const auto offset = content.number<std::uint64_t>();
  return {offset, content.number<std::uint64_t>()};
}

void add_summary_record(Contents& contents, Op op, std::string_view content) {
  switch (op) {
    case Op::schema:
      return add_schema(contents, content);
    case Op::channel:
      return add_channel(contents, content);
    case Op::statistics:
      contents.message_count = Cursor{content}.number<std::uint64_t>();
      return;
    case Op::chunk_index:
      contents.chunks.push_back(read_chunk_index(Cursor{content}));
      return;
    case Op::metadata_index:
      contents.metadata.push_back(read_place(Cursor{content}));
      return;
    case Op::attachment_index:
      contents.attachments.push_back(read_place(Cursor{content}));
      return;
    default:
      return;
  }
}

/// @return the summary section after a check of its CRC; empty when it is missing or damaged
std::string read_summary(const InputFile& file) {
  constexpr std::uint64_t kTail = mcap::kRecordHead + mcap::kFooterSize + mcap::kMagic.size();
  if (file.size() < mcap::kMagic.size() + kTail) return {};
  const std::string tail = file.read(file.size() - kTail, kTail);
  if (!tail.ends_with(mcap::kMagic)) return {};
  Cursor cursor{tail};
  const auto op = cursor.number<std::uint8_t>();
  const auto length = cursor.number<std::uint64_t>();
  const auto start = cursor.number<std::uint64_t>();
  (void)cursor.number<std::uint64_t>();
  const auto crc = cursor.number<std::uint32_t>();
  if (op != static_cast<std::uint8_t>(Op::footer) || length != mcap::kFooterSize) return {};
  const std::uint64_t footer_at = file.size() - kTail;
  if (start < mcap::kMagic.size() || start >= footer_at) return {};
  std::string section = file.read(start, footer_at - start);
  mcap::Crc32 computed;
  computed.add(section.data(), section.size());
  computed.add(tail.data(), mcap::kRecordHead + mcap::kFooterSize - sizeof(crc));
  if (crc != 0 && crc != computed.value()) return {};
  return section;
}

std::string unpack(std::string_view packed, std::string_view compression, std::uint64_t size) {
  if (compression.empty()) return std::string{packed};
  if (compression != "zstd")
    throw FormatError("compression \"" + std::string{compression} + "\" is not supported");
  const unsigned long long declared = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (declared == ZSTD_CONTENTSIZE_ERROR) throw FormatError("no zstd frame begins here");
  const bool known = declared != ZSTD_CONTENTSIZE_UNKNOWN;
  if (size > kMaxChunk) throw FormatError("unpacked size " + std::to_string(size) + " is above 64 MiB");
  if (known && declared != size)
    throw FormatError("the stated size of the chunk differs from its unpacked size");
  std::string out(size, '\0');
  const std::size_t got = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0U) throw FormatError(std::string{"zstd: "} + ZSTD_getErrorName(got));
  if (got != size) throw FormatError("the stated size of the chunk differs from its unpacked size");
  return out;
}

/// True when two entries of the index name the same bytes: a small file could then be read without end.
bool overlap(const Contents& contents) {
  std::vector<Place> places = contents.metadata;
  places.insert(places.end(), contents.attachments.begin(), contents.attachments.end());
  for (const ChunkPlace& chunk : contents.chunks) places.push_back(chunk.place);
  std::ranges::sort(places, {}, &Place::offset);
  for (std::size_t i = 1; i < places.size(); ++i)
    if (places[i].offset - places[i - 1].offset < places[i - 1].length) return true;
  return false;
}

/// Scans a file; see walk().
class Walker {
 public:
  Walker(const InputFile& file, std::vector<std::string>& problems) : file_{file}, problems_{problems} {}

  Contents run() {
    std::uint64_t at = mcap::kMagic.size();
    while (at < file_.size()) {
      const std::optional<Place> place = record_at(at);
      if (!place) {
        at = pass_over_damage(at);
        continue;
      }
      if (take(*place)) return std::move(contents_);
      at += place->length;
    }
    return std::move(contents_);
  }

 private:
  /// @return the record at `at`; nothing when there is no complete record
  std::optional<Place> record_at(std::uint64_t at) {
    const std::string head = file_.read(at, mcap::kRecordHead);
    if (head.size() < mcap::kRecordHead) return std::nullopt;
    Cursor cursor{head};
    op_ = static_cast<Op>(cursor.number<std::uint8_t>());
    const auto length = cursor.number<std::uint64_t>();
    if (op_ < Op::header || (op_ > Op::data_end && static_cast<std::uint8_t>(op_) < 0x80))
      return std::nullopt;
    if (length > file_.size() - at - mcap::kRecordHead) return std::nullopt;
    return Place{at, mcap::kRecordHead + length};
  }

  /// @return true at the footer
  bool take(const Place& place) {
    switch (op_) {
      case Op::footer:
        return true;
      case Op::chunk:
        take_chunk(place);
        return false;
      case Op::metadata:
        contents_.metadata.push_back(place);
        return false;
      case Op::attachment:
        contents_.attachments.push_back(place);
        return false;
      case Op::message:
        report(place.offset, "a message outside a chunk is not read");
        return false;
      default:
        return false;
    }
  }

  void take_chunk(const Place& place) {
    try {
      const std::string records = unpack_chunk(file_, place);
      ChunkPlace chunk{place};
      Cursor cursor{records};
      while (!cursor.empty()) {
        const auto op = static_cast<Op>(cursor.number<std::uint8_t>());
        const std::string_view content = cursor.raw(cursor.number<std::uint64_t>());
        if (op == Op::schema) add_schema(contents_, content);
        if (op == Op::channel) add_channel(contents_, content);
        if (op == Op::message) add_time(chunk, content);
      }
      contents_.chunks.push_back(chunk);
    } catch (const FormatError& error) {
      report(place.offset, std::string{"chunk is damaged and skipped: "} + error.what());
    }
  }

  static void add_time(ChunkPlace& chunk, std::string_view content) {
    Cursor cursor{content};
    (void)cursor.number<std::uint16_t>();
    (void)cursor.number<std::uint32_t>();
    const std::int64_t time_ns = cursor.time();
    chunk.first_ns = chunk.has_messages ? std::min(chunk.first_ns, time_ns) : time_ns;
    chunk.last_ns = chunk.has_messages ? std::max(chunk.last_ns, time_ns) : time_ns;
    chunk.has_messages = true;
  }

  /// @return offset of the next chunk, or the end of the file
  std::uint64_t pass_over_damage(std::uint64_t at) {
    constexpr std::uint64_t kBlock = 1U << 20U;
    constexpr std::string_view kMark{"\x04\0\0\0zstd", 8};  // compression field of every chunk of McapWriter
    constexpr std::uint64_t kMarkAt = mcap::kRecordHead + 28;
    for (std::uint64_t block = at; block < file_.size(); block += kBlock) {
      const std::string bytes = file_.read(block, kBlock + kMark.size());
      for (std::size_t i = bytes.find(kMark); i != std::string::npos; i = bytes.find(kMark, i + 1)) {
        if (block + i < at + 1 + kMarkAt) continue;
        const std::uint64_t candidate = block + i - kMarkAt;
        if (!record_at(candidate) || op_ != Op::chunk) continue;
        report(at, std::to_string(candidate - at) + " bytes are damaged and skipped");
        return candidate;
      }
    }
    report(at, "the file ends inside a record: its last " + std::to_string(file_.size() - at) +
                   " bytes are lost");
    return file_.size();
  }

  void report(std::uint64_t at, const std::string& what) {
    problems_.push_back(file_.name() + ": byte " + std::to_string(at) + ": " + what);
  }

  const InputFile& file_;
  std::vector<std::string>& problems_;
  Contents contents_;
  Op op_ = Op::header;  // of the record record_at() found last
};

}  // namespace

std::optional<Contents> read_index(const InputFile& file) {
  const std::string section = read_summary(file);
  if (section.empty()) return std::nullopt;
  Contents contents;
  try {
    Cursor cursor{section};
    while (!cursor.empty()) {
      const auto op = static_cast<Op>(cursor.number<std::uint8_t>());
      add_summary_record(contents, op, cursor.raw(cursor.number<std::uint64_t>()));
    }
  } catch (const FormatError&) {
    return std::nullopt;
  }
  // A writer may omit the chunk index; walk() then finds the chunks.
  if (contents.chunks.empty() && contents.message_count > 0) return std::nullopt;
  if (overlap(contents)) return std::nullopt;
  return contents;
}

Contents walk(const InputFile& file, std::vector<std::string>& problems) {
  return Walker{file, problems}.run();
}

std::string unpack_chunk(const InputFile& file, const Place& chunk) {
  const std::string bytes = file.read(chunk.offset, chunk.length);
  Cursor cursor{bytes};
  if (static_cast<Op>(cursor.number<std::uint8_t>()) != Op::chunk) throw FormatError("no chunk begins here");
  if (cursor.number<std::uint64_t>() != chunk.length - mcap::kRecordHead)
    throw FormatError("length is wrong");
  (void)cursor.time();
  (void)cursor.time();
  const auto size = cursor.number<std::uint64_t>();
  const auto crc = cursor.number<std::uint32_t>();
  const std::string_view compression = cursor.text();
  std::string records = unpack(cursor.raw(cursor.number<std::uint64_t>()), compression, size);
  if (crc != 0 && crc != mcap::crc32(records.data(), records.size())) throw FormatError("CRC is wrong");
  return records;
}

void add_schema(Contents& contents, std::string_view content) {
  Cursor cursor{content};
  SchemaRecord schema;
  schema.id = cursor.number<std::uint16_t>();
  schema.name = fields::printable(cursor.text());
  schema.encoding = cursor.text();
  schema.text = cursor.text();
  contents.schemas[schema.id] = std::move(schema);
}

void add_channel(Contents& contents, std::string_view content) {
  Cursor cursor{content};
  ChannelRecord channel;
  channel.id = cursor.number<std::uint16_t>();
  channel.schema_id = cursor.number<std::uint16_t>();
  channel.topic = fields::printable(cursor.text());
  channel.message_encoding = cursor.text();
  channel.metadata = cursor.map();
  contents.channels[channel.id] = std::move(channel);
}

}  // namespace crane::recording
