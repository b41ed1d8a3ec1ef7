#pragma once
/// Writes recordings in MCAP (mcap.dev/spec): chunked, zstd-compressed, indexed, every part under a CRC-32.
/// The file only grows, so whatever was flushed stays readable if the process or the machine dies; see
/// mcap_reader.hpp for reading and repairing. Same calls, same bytes. One thread.
///
///   McapWriter writer{"run.mcap"};
///   const TopicChannels channels = add_topic_channels(writer);
///   writer.message(channels[0], tick, sample_time_ns, publish_time_ns, cdr);
///   writer.close();
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "crane/topics.hpp"

namespace crane::recording {

using Metadata = std::map<std::string, std::string>;
using Bytes = std::span<const std::uint8_t>;

/// The file could not be created or grown: "run.mcap: cannot write: No space left on device". What was
/// flushed before remains readable; the writer takes nothing more and repeats the error.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct WriterOptions {
  std::size_t chunk_bytes = 1U << 20U;             ///< a chunk is closed at this size, > 0
  std::int64_t flush_interval_ns = 1'000'000'000;  ///< or when its messages span this much log time
  int compression_level = 1;                       ///< zstd, 1..19
  bool sync = false;  ///< fdatasync after each chunk: survives a power cut, not only a crash
};

class McapWriter {
 public:
  /// Creates or truncates `file`. @throws WriteError
  explicit McapWriter(const std::filesystem::path& file, const WriterOptions& options = {});
  /// Closes; an error that close() would have thrown is lost, so call close().
  ~McapWriter();
  McapWriter(McapWriter&&) noexcept;
  McapWriter& operator=(McapWriter&&) noexcept;

  /// @param encoding "omgidl", "jsonschema", ... @return id, 1, 2, ... in order of the calls
  std::uint16_t schema(std::string_view name, std::string_view encoding, std::string_view text);
  /// @param schema id from schema(), 0: none. @param message_encoding "cdr", "json", ... @return id, 0, 1,
  /// ...
  /// @throws std::invalid_argument for an unknown schema
  std::uint16_t channel(std::uint16_t schema, std::string_view topic, std::string_view message_encoding,
                        const Metadata& metadata = {});
  /// Appends to the current chunk. @param data for "cdr": with the 4-byte encapsulation header
  /// @throws WriteError, std::invalid_argument for an unknown channel
  void message(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time_ns,
               std::int64_t publish_time_ns, Bytes data);
  /// Both close the current chunk first. @throws WriteError
  void metadata(std::string_view name, const Metadata& entries);
  void attachment(std::string_view name, std::string_view media_type, std::int64_t time_ns, Bytes data);

  /// Closes the chunk and hands it to the operating system: at a fault, at a trigger. @throws WriteError
  void flush();
  /// Writes index and footer. Calling it again does nothing. @throws WriteError
  void close();

  [[nodiscard]] std::uint64_t message_count() const;
  [[nodiscard]] std::uint64_t bytes_written() const;  ///< in the file; the open chunk is not in it yet

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Channel ids in the order of topics::kAll.
using TopicChannels = std::array<std::uint16_t, topics::kAll.size()>;
/// Declares one CDR channel per topic with crane.idl as its schema.
TopicChannels add_topic_channels(McapWriter& writer);

}  // namespace crane::recording
