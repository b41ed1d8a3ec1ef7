#pragma once
/// Reads MCAP recordings in the order of log time and checks every CRC. From a truncated or damaged file the
/// reader returns all intact chunks, and problems() lists the losses. The parts of a split recording
/// (parts.hpp) are read as one recording.
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

/// The file cannot be opened, or is not an MCAP file. what() names file and reason.
class ReadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SchemaRecord {
  std::uint16_t id = 0;
  std::string name, encoding, text;
  bool operator==(const SchemaRecord&) const = default;
};
struct ChannelRecord {
  std::uint16_t id = 0, schema_id = 0;
  std::string topic, message_encoding;
  Metadata metadata;
  bool operator==(const ChannelRecord&) const = default;
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

/// One message. `channel` and `data` are valid during the callback only.
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

class McapReader;

/// Iterates over the selected messages in the order of log time; messages with equal times are in file order.
/// Made by McapReader::messages(); the reader must outlive it.
class MessageStream {
 public:
  ~MessageStream();
  MessageStream(MessageStream&&) noexcept;
  MessageStream& operator=(MessageStream&&) noexcept;
  /// @return valid until the next call; nullptr after the last message. Damaged chunks are skipped and
  ///   reported in McapReader::problems()
  [[nodiscard]] const Message* next();

 private:
  friend class McapReader;
  struct State;
  explicit MessageStream(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

class McapReader {
 public:
  /// Reads the index. Without an intact index it scans the whole file.
  /// @param recording  a file, or the name of a recording whose parts exist
  /// @throws ReadError, also when the parts belong to different recordings
  explicit McapReader(const std::filesystem::path& recording);
  ~McapReader();
  McapReader(McapReader&&) noexcept;
  McapReader& operator=(McapReader&&) noexcept;

  [[nodiscard]] const std::vector<std::filesystem::path>& files() const;  ///< the file, or all parts
  [[nodiscard]] const std::vector<SchemaRecord>& schemas() const;         ///< by id
  [[nodiscard]] const std::vector<ChannelRecord>& channels() const;       ///< by id
  [[nodiscard]] const SchemaRecord* find_schema(std::uint16_t id) const;  ///< nullptr: none
  [[nodiscard]] std::vector<MetadataRecord> metadata();                   ///< in file order
  [[nodiscard]] std::vector<AttachmentRecord> attachments();
  /// True when every file was closed correctly, with an intact index and footer.
  [[nodiscard]] bool indexed() const;
  [[nodiscard]] std::int64_t first_time_ns() const;  ///< first log time of all chunks; 0 without chunks
  [[nodiscard]] std::int64_t last_time_ns() const;   ///< last log time of all chunks; 0 without chunks

  [[nodiscard]] MessageStream messages(const Selection& selection = {});
  /// Calls `visit` for each selected message in the order of messages(), until `visit` returns false.
  void for_each(const Selection& selection, const std::function<bool(const Message&)>& visit);

  /// Problems found so far, one line each, with file and byte position. Reading may add problems.
  [[nodiscard]] const std::vector<std::string>& problems() const;

 private:
  friend class MessageStream;
  struct State;
  std::unique_ptr<State> state_;
};

struct CheckReport {
  std::uint64_t messages = 0;         ///< number of readable messages
  std::vector<std::string> problems;  ///< empty: the file is intact
};

/// Reads the whole file. @throws ReadError
[[nodiscard]] CheckReport check(const std::filesystem::path& file);

/// Copies all readable data from `damaged` to the file `repaired`. The file `repaired` appears, or replaces
/// an existing file, only when it is complete.
/// @return number of copied messages, and the losses. @throws ReadError, WriteError
CheckReport repair(const std::filesystem::path& damaged, const std::filesystem::path& repaired);

}  // namespace crane::recording
