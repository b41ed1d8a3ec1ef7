#pragma once
/// Writes recordings in MCAP (mcap.dev/spec) with chunks, zstd compression, an index and a CRC-32 for every
/// part. The writer only appends to the file, so that all flushed data remain readable when the process or
/// the computer fails (mcap_reader.hpp reads and repairs). Equal calls give equal bytes. Not thread-safe.
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

#include "crane/files/complete_file.hpp"
#include "crane/topics.hpp"

namespace crane::recording {

using Metadata = std::map<std::string, std::string>;
using Bytes = std::span<const std::uint8_t>;

/// The file cannot be created or extended: "run.mcap: cannot write: No space left on device". Data that were
/// flushed before remain readable. The writer accepts no more data; every further call throws the same error.
using files::WriteError;

struct WriterOptions {
  std::size_t chunk_bytes = 1U << 20U;             ///< size at which a chunk is closed, bytes, > 0
  std::int64_t flush_interval_ns = 1'000'000'000;  ///< log time after which a chunk is closed
  int compression_level = 1;                       ///< zstd, 1..19
  bool sync = false;  ///< true: fdatasync after each chunk, so that flushed data also survive a power failure
  bool replace = true;  ///< false: an existing file is not overwritten; the constructor throws WriteError
};

class McapWriter {
 public:
  /// Creates `file`, or truncates it. @throws WriteError
  explicit McapWriter(const std::filesystem::path& file, const WriterOptions& options = {});
  /// Closes the file and ignores errors. Call close() before to receive the errors.
  ~McapWriter();
  McapWriter(McapWriter&&) noexcept;
  McapWriter& operator=(McapWriter&&) noexcept;

  /// Adds a schema. @param encoding  "omgidl", "jsonschema", ... @return its id: 1, 2, ... in the order of
  /// the calls
  std::uint16_t schema(std::string_view name, std::string_view encoding, std::string_view text);
  /// Adds a channel. @return its id: 0, 1, ... in the order of the calls
  /// @param schema            id from schema(); 0: none
  /// @param message_encoding  "cdr", "json", ...
  /// @throws std::invalid_argument for an unknown schema
  std::uint16_t channel(std::uint16_t schema, std::string_view topic, std::string_view message_encoding,
                        const Metadata& metadata = {});
  /// Appends a message to the current chunk. @param data  for "cdr": with the 4-byte encapsulation header
  /// @throws WriteError, std::invalid_argument for an unknown channel
  void message(std::uint16_t channel, std::uint32_t sequence, std::int64_t log_time_ns,
               std::int64_t publish_time_ns, Bytes data);
  /// Appends a metadata record or an attachment. Both close the current chunk first. @throws WriteError
  void metadata(std::string_view name, const Metadata& entries);
  void attachment(std::string_view name, std::string_view media_type, std::int64_t time_ns, Bytes data);

  /// Closes the current chunk and writes it to the file, for example at a fault. @throws WriteError
  void flush();
  /// Writes index and footer. Further calls of close() have no effect; every other writing call then throws
  /// std::logic_error. @throws WriteError
  void close();

  [[nodiscard]] std::uint64_t message_count() const;
  [[nodiscard]] std::uint64_t bytes_written() const;  ///< size of the file, without the current chunk
  /// Upper bound for the size of the file if close() were called after `more` bytes of message data.
  [[nodiscard]] std::uint64_t closed_bytes(std::size_t more) const;
  /// @return true when no directory contains the file any more: somebody has deleted it
  [[nodiscard]] bool removed() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Channel ids in the order of topics::kAll.
using TopicChannels = std::array<std::uint16_t, topics::kAll.size()>;
/// Adds one CDR channel per topic. The schema of all channels is the text of crane.idl.
TopicChannels add_topic_channels(McapWriter& writer);

}  // namespace crane::recording
