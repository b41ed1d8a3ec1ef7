#pragma once
/// The MCAP format (mcap.dev/spec), shared by writer and reader. A record is `opcode u8, length u64,
/// content`, little endian. Texts and maps have a u32 length before their content.
#include <array>
#include <boost/crc.hpp>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "crane/fields/printable.hpp"
#include "crane/recording/mcap_writer.hpp"

namespace crane::recording::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t kRecordHead = 9;   ///< opcode and length
inline constexpr std::size_t kFooterSize = 20;  ///< content of the footer record
/// Maximum length of a record, bytes. A larger value is a damaged length.
inline constexpr std::uint64_t kMaxRecord = 1ULL << 32U;

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F
};

/// CRC-32 of ISO 3309, the checksum of MCAP.
class Crc32 {
 public:
  void add(const void* data, std::size_t size) { crc_.process_bytes(data, size); }
  [[nodiscard]] std::uint32_t value() const { return crc_.checksum(); }

 private:
  boost::crc_32_type crc_;
};
inline std::uint32_t crc32(const void* data, std::size_t size) {
  Crc32 crc;
  crc.add(data, size);
  return crc.value();
}

/// Builds the content of a record.
class Content {
 public:
  template <class T>
  Content& number(T value) {
    static_assert(std::is_unsigned_v<T>);
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<char>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xFFU));
    return *this;
  }
  Content& time(std::int64_t ns) { return number(static_cast<std::uint64_t>(ns)); }
  Content& raw(std::string_view bytes) {
    bytes_.append(bytes);
    return *this;
  }
  Content& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    return raw(value);
  }
  Content& map(const Metadata& entries) {
    Content inner;
    for (const auto& [key, value] : entries) inner.text(key).text(value);
    return text(inner.bytes());
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Opcode, length and content.
inline std::string record(Op op, std::string_view content) {
  Content head;
  head.number(static_cast<std::uint8_t>(op)).number(static_cast<std::uint64_t>(content.size())).raw(content);
  return head.bytes();
}

/// The content of a record is malformed.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads the content of a record with bounds checks. @throws FormatError
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_{bytes} {}
  template <class T>
  T number() {
    static_assert(std::is_unsigned_v<T>);
    const std::string_view bytes = raw(sizeof(T));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes[i])) << (8 * i);
    return static_cast<T>(value);
  }
  std::int64_t time() { return static_cast<std::int64_t>(number<std::uint64_t>()); }
  std::string_view raw(std::uint64_t size) {
    if (size > rest_.size()) throw FormatError("record ends inside a field");
    const std::string_view bytes = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return bytes;
  }
  std::string_view text() { return raw(number<std::uint32_t>()); }
  Metadata map() {
    Cursor inner{text()};
    Metadata entries;
    while (!inner.empty()) {
      auto key = fields::printable(inner.text());
      entries[std::move(key)] = fields::printable(inner.text());
    }
    return entries;
  }
  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

}  // namespace crane::recording::mcap
