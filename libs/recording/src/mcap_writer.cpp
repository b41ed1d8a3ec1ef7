#include "crane/recording/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <vector>

#include "mcap_format.hpp"
#include "mcap_summary.hpp"
#include "output_file.hpp"

namespace crane::recording {
namespace {

using mcap::Content;
using mcap::Op;
using mcap::record;

std::string_view view(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::string compress(std::string_view data, int level) {
  std::string out(ZSTD_compressBound(data.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), data.data(), data.size(), level);
  if (ZSTD_isError(size) != 0U) throw WriteError(std::string{"zstd: "} + ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

}  // namespace

struct McapWriter::State {
  State(const std::filesystem::path& path, const WriterOptions& chosen)
      : options{chosen}, file{path, chosen.replace} {
    file.append(std::string{mcap::kMagic} + record(Op::header, Content{}.text("").text("crane").bytes()));
  }

  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    try {
      close();
    } catch (const WriteError&) {
      // A destructor cannot report the error; close() does.
    }
  }

  WriterOptions options;
  OutputFile file;
  bool closed = false;
  std::string chunk;          // records of the open chunk
  mcap::TimeSpan chunk_span;  // log times of its messages
  std::map<std::uint16_t, Content>
      chunk_index;  // per channel: (log time, offset in the chunk) of each message
  mcap::Summary summary;

  void require_open() const;
  void end_chunk();
  [[nodiscard]] std::uint64_t closed_bytes(std::size_t more) const;
  void close();
};

void McapWriter::State::require_open() const {
  if (closed) throw std::logic_error("recording is closed");
  file.require_good();
}

/// Appends a chunk with its message indexes in one write, so that after a failure the file ends with a
/// complete chunk.
void McapWriter::State::end_chunk() {
  if (chunk.empty()) return;
  const std::string packed = compress(chunk, options.compression_level);
  const std::uint64_t start = file.size();
  const auto unpacked_size = static_cast<std::uint64_t>(chunk.size());
  const auto packed_size = static_cast<std::uint64_t>(packed.size());
  std::string out = record(Op::chunk, Content{}
                                          .time(chunk_span.first)
                                          .time(chunk_span.last)
                                          .number(unpacked_size)
                                          .number(mcap::crc32(chunk.data(), chunk.size()))
                                          .text("zstd")
                                          .number(packed_size)
                                          .raw(packed)
                                          .bytes());
  const auto length = static_cast<std::uint64_t>(out.size());
  Content offsets;
  for (const auto& [channel, entries] : chunk_index) {
    offsets.number(channel).number(start + out.size());
    out += record(Op::message_index, Content{}.number(channel).text(entries.bytes()).bytes());
  }
  file.append(out);
  if (options.sync) file.sync();
  summary.keep(summary.chunks,
               record(Op::chunk_index, Content{}
                                           .time(chunk_span.first)
                                           .time(chunk_span.last)
                                           .number(start)
                                           .number(length)
                                           .text(offsets.bytes())
                                           .number(static_cast<std::uint64_t>(out.size()) - length)
                                           .text("zstd")
                                           .number(packed_size)
                                           .number(unpacked_size)
                                           .bytes()));
  chunk.clear();
  chunk_index.clear();
  chunk_span = {};
}

std::uint64_t McapWriter::State::closed_bytes(std::size_t more) const {
  // Upper bounds for one record without its variable parts, and for the parts per channel and per message.
  constexpr std::uint64_t kRecord = 128, kPerChannel = 64, kPerMessage = 16, kSummary = 1024;
  std::uint64_t entries = 0;
  for (const auto& [channel, index] : chunk_index) entries += index.bytes().size();
  std::uint64_t sum = file.size() + kSummary + kPerChannel * summary.channels.size();
  sum += ZSTD_compressBound(chunk.size() + kRecord + more) + entries + kPerMessage + kRecord;
  sum += kRecord + kPerChannel * summary.channels.size();  // index of the open chunk
  return sum + summary.bytes();
}

void McapWriter::State::close() {
  if (closed) return;
  file.require_good();
  end_chunk();
  file.append(summary.closing(file.size()));
  if (options.sync) file.sync();
  file.close();
  closed = true;
}

McapWriter::McapWriter(const std::filesystem::path& file, const WriterOptions& options)
    : state_{std::make_unique<State>(file, options)} {}

McapWriter::~McapWriter() = default;
McapWriter::McapWriter(McapWriter&&) noexcept = default;
McapWriter& McapWriter::operator=(McapWriter&&) noexcept = default;

std::uint16_t McapWriter::schema(std::string_view name, std::string_view encoding, std::string_view text) {
  State& s = *state_;
  s.require_open();
  const auto id = static_cast<std::uint16_t>(s.summary.schemas.size() + 1);
  s.summary.keep(s.summary.schemas,
                 record(Op::schema, Content{}.number(id).text(name).text(encoding).text(text).bytes()));
  s.chunk += s.summary.schemas.back();
  return id;
}

std::uint16_t McapWriter::channel(std::uint16_t schema, std::string_view topic,
                                  std::string_view message_encoding, const Metadata& metadata) {
  State& s = *state_;
  s.require_open();
  if (schema > s.summary.schemas.size())
    throw std::invalid_argument("schema " + std::to_string(schema) + " is not declared");
  const auto id = static_cast<std::uint16_t>(s.summary.channels.size());
  s.summary.keep(
      s.summary.channels,
      record(Op::channel,
             Content{}.number(id).number(schema).text(topic).text(message_encoding).map(metadata).bytes()));
  s.chunk += s.summary.channels.back();
  return id;
}

void McapWriter::message(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time_ns,
                         std::int64_t publish_time_ns, Bytes data) {
  State& s = *state_;
  s.require_open();
  if (channel >= s.summary.channels.size())
    throw std::invalid_argument("channel " + std::to_string(channel) + " is not declared");
  s.chunk_index[channel].time(log_time_ns).number(static_cast<std::uint64_t>(s.chunk.size()));
  s.chunk += record(Op::message, Content{}
                                     .number(channel)
                                     .number(sequence)
                                     .time(log_time_ns)
                                     .time(publish_time_ns)
                                     .raw(view(data))
                                     .bytes());
  ++s.summary.counts[channel];
  s.chunk_span.add(log_time_ns);
  s.summary.span.add(log_time_ns);
  const bool long_enough = s.chunk_span.last - s.chunk_span.first >= s.options.flush_interval_ns;
  if (long_enough || s.chunk.size() >= s.options.chunk_bytes) s.end_chunk();
}

void McapWriter::metadata(std::string_view name, const Metadata& entries) {
  State& s = *state_;
  s.require_open();
  s.end_chunk();
  const std::uint64_t start = s.file.size();
  const std::string out = record(Op::metadata, Content{}.text(name).map(entries).bytes());
  s.file.append(out);
  s.summary.keep(
      s.summary.metadata,
      record(Op::metadata_index,
             Content{}.number(start).number(static_cast<std::uint64_t>(out.size())).text(name).bytes()));
}

void McapWriter::attachment(std::string_view name, std::string_view media_type, std::int64_t time_ns,
                            Bytes data) {
  State& s = *state_;
  s.require_open();
  s.end_chunk();
  const std::uint64_t start = s.file.size();
  Content content;
  content.time(time_ns).time(time_ns).text(name).text(media_type);
  content.number(static_cast<std::uint64_t>(data.size())).raw(view(data));
  content.number(mcap::crc32(content.bytes().data(), content.bytes().size()));
  const std::string out = record(Op::attachment, content.bytes());
  s.file.append(out);
  s.summary.keep(s.summary.attachments,
                 record(Op::attachment_index, Content{}
                                                  .number(start)
                                                  .number(static_cast<std::uint64_t>(out.size()))
                                                  .time(time_ns)
                                                  .time(time_ns)
                                                  .number(static_cast<std::uint64_t>(data.size()))
                                                  .text(name)
                                                  .text(media_type)
                                                  .bytes()));
}

void McapWriter::flush() {
  state_->require_open();
  state_->end_chunk();
}

void McapWriter::close() { state_->close(); }

std::uint64_t McapWriter::message_count() const { return state_->summary.messages(); }

std::uint64_t McapWriter::bytes_written() const { return state_->file.size(); }

std::uint64_t McapWriter::closed_bytes(std::size_t more) const { return state_->closed_bytes(more); }

bool McapWriter::removed() const { return state_->file.removed(); }

TopicChannels add_topic_channels(McapWriter& writer) {
  std::map<std::string_view, std::uint16_t> schemas;
  TopicChannels channels{};
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const topics::Description& topic = topics::kAll[i];
    const auto [entry, added] = schemas.try_emplace(topic.type, std::uint16_t{0});
    if (added) entry->second = writer.schema(topic.type, "omgidl", topics::idl_text());
    channels[i] = writer.channel(entry->second, topic.name, "cdr");
  }
  return channels;
}

}  // namespace crane::recording
