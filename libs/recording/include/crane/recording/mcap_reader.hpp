#pragma once
/// Reads MCAP recordings in log order, checks every CRC, and gets out of a cut or damaged file what can be
/// trusted: all intact chunks. What is lost is said in problems(), never skipped silently.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/recording/mcap_writer.hpp"

namespace crane::recording {

/// The file cannot be opened, or is no MCAP file at all; names file and reason.
class ReadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SchemaRecord {
  std::uint16_t id = 0;
  std::string name, encoding, text;
};
struct ChannelRecord {
  std::uint16_t id = 0, schema_id = 0;
  std::string topic, message_encoding;
  Metadata metadata;
};
struct MetadataRecord {
  std::string name;
  Metadata entries;
};
struct AttachmentRecord {
  std::string name, media_type;
  std::int64_t time_ns = 0;
  std::vector<std::uint8_t> data;
};

/// One message; `channel` and `data` are valid inside the callback.
struct Message {
  const ChannelRecord* channel = nullptr;
  std::uint32_t sequence = 0;
  std::int64_t log_time_ns = 0, publish_time_ns = 0;
  Bytes data;
};

struct Selection {
  std::vector<std::string> topics;  ///< empty: all
  std::int64_t from_ns = std::numeric_limits<std::int64_t>::min();
  std::int64_t until_ns = std::numeric_limits<std::int64_t>::max();  ///< inclusive
};

class McapReader {
 public:
  /// Reads the index; without a usable one, walks the file. @throws ReadError
  explicit McapReader(const std::filesystem::path& file);
  ~McapReader();
  McapReader(McapReader&&) noexcept;
  McapReader& operator=(McapReader&&) noexcept;

  [[nodiscard]] const std::vector<SchemaRecord>& schemas() const;         ///< by id
  [[nodiscard]] const std::vector<ChannelRecord>& channels() const;       ///< by id
  [[nodiscard]] const SchemaRecord* find_schema(std::uint16_t id) const;  ///< nullptr: none
  [[nodiscard]] std::vector<MetadataRecord> metadata();                   ///< in file order
  [[nodiscard]] std::vector<AttachmentRecord> attachments();
  [[nodiscard]] bool indexed() const;  ///< closed properly: index and footer are there and intact
  [[nodiscard]] std::int64_t first_time_ns() const;  ///< log times of the chunks, 0 when there are none
  [[nodiscard]] std::int64_t last_time_ns() const;

  /// Calls `visit` for each selected message by log time (equal times: in file order) until it returns false.
  /// Damaged chunks are left out and named in problems().
  void for_each(const Selection& selection, const std::function<bool(const Message&)>& visit);

  /// What was found wrong so far, one line each with file and byte position; grows while reading.
  [[nodiscard]] const std::vector<std::string>& problems() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct CheckReport {
  std::uint64_t messages = 0;         ///< readable
  std::vector<std::string> problems;  ///< empty: the file is whole
};

/// Reads the whole file. @throws ReadError
[[nodiscard]] CheckReport check(const std::filesystem::path& file);

/// Writes everything readable of `damaged` as a good file `repaired`, which appears only when complete.
/// @return what was copied and what is lost. @throws ReadError, WriteError
CheckReport repair(const std::filesystem::path& damaged, const std::filesystem::path& repaired);

}  // namespace crane::recording
