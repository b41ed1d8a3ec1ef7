#pragma once
/// Positions of the records in an MCAP file, from its index or by a scan.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crane/recording/mcap_reader.hpp"
#include "input_file.hpp"

namespace crane::recording {

/// Position of a record in the file, including opcode and length.
struct Place {
  std::uint64_t offset = 0, length = 0;
  std::size_t part = 0;  ///< index of the file in a recording of several parts
};

struct ChunkPlace {
  Place place;
  std::int64_t first_ns = 0, last_ns = 0;
  bool has_messages = false;
};

struct Contents {
  std::map<std::uint16_t, SchemaRecord> schemas;
  std::map<std::uint16_t, ChannelRecord> channels;
  std::vector<ChunkPlace> chunks;
  std::vector<Place> metadata, attachments;
  std::uint64_t message_count = 0;  ///< number of messages according to the index
};

/// @return nothing when index or footer are missing or damaged
[[nodiscard]] std::optional<Contents> read_index(const InputFile& file);

/// Scans the file record by record and skips damaged parts. @param problems  found problems are appended
[[nodiscard]] Contents walk(const InputFile& file, std::vector<std::string>& problems);

/// Unpacked records of a chunk, checked against its CRC. @throws mcap::FormatError with the problem
[[nodiscard]] std::string unpack_chunk(const InputFile& file, const Place& chunk);

/// Stores the content of a schema or channel record. @throws mcap::FormatError
void add_schema(Contents& contents, std::string_view content);
void add_channel(Contents& contents, std::string_view content);

}  // namespace crane::recording
