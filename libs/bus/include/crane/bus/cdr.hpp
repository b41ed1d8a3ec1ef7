#pragma once
/// Encodes and decodes the C struct of a topic as plain CDR (XCDR1, little endian), for Fast DDS, recordings,
/// CRC and tools. The codec reads the op-codes that idlc 0.10 writes to the topic descriptor.
#include <cstdint>
#include <span>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

/// Header of a CDR payload in messages and recordings: encoding and options.
inline constexpr std::size_t kEncapsulation_bytes = 4;

/// Layout of one message type.
class CdrCodec {
 public:
  /// One primitive, enum or string, or an array of primitives or enums. Nested structs are flattened.
  struct Field {
    enum class Kind : std::uint8_t { number, floating, boolean, enumeration, string };
    std::uint32_t offset = 0;    ///< bytes from the start of the C struct
    std::uint32_t size = 0;      ///< bytes of one element; string: 1
    std::uint32_t count = 1;     ///< number of elements; string: capacity with the final NUL
    std::uint32_t enum_max = 0;  ///< enumeration: largest valid value
    Kind kind = Kind::number;
    bool key = false;
    bool operator==(const Field&) const = default;
  };

  /// @throws Error, with the names of type and field, when the type uses a construct other than primitives,
  ///   enums, bounded strings, arrays of these and nested @final structs, or a @key that is not one top-level
  ///   primitive
  explicit CdrCodec(const dds_topic_descriptor_t& descriptor);

  /// @return the shared codec of a type. The first call creates it. Thread-safe
  static const CdrCodec& of(const dds_topic_descriptor_t& descriptor);

  [[nodiscard]] std::size_t max_encoded_bytes() const;  ///< without the encapsulation header
  [[nodiscard]] std::size_t sample_bytes() const;       ///< sizeof the C struct
  [[nodiscard]] bool has_key() const;
  [[nodiscard]] bool has_texts() const;                                       ///< true: has string fields
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }  ///< in order of encoding
  /// @return true when the type begins with crane::Header and ends with a uint32 for the CRC
  [[nodiscard]] bool is_sealable() const;

  /// @return bytes written (without encapsulation header); 0 when `out` is too small or a string is not
  ///   terminated
  [[nodiscard]] std::size_t encode(const void* sample, std::span<std::uint8_t> out) const;
  /// Checks the length of `in`, and the values of booleans, enums and strings. @return false when `in` is not
  /// a valid sample; `sample` must then not be used
  [[nodiscard]] bool decode(std::span<const std::uint8_t> in, bool big_endian, void* sample) const;
  /// Big-endian CDR of the key fields, for the RTPS key hash. @return bytes written
  [[nodiscard]] std::size_t encode_key(const void* sample, std::span<std::uint8_t> out) const;
  /// Decodes the key fields in either byte order; the other fields keep their values. @return false when `in`
  /// is too short
  [[nodiscard]] bool decode_key(std::span<const std::uint8_t> in, bool big_endian, void* sample) const;

  /// Makes all texts of a sample printable (crane/fields/printable.hpp). @return true when a text has changed
  bool make_texts_printable(void* sample) const;

 private:
  /// Fields of fixed size without padding between them, in the struct and in CDR: encoded by one copy. A
  /// string is a block of its own.
  struct Block {
    std::uint32_t offset = 0;     ///< bytes from the start of the C struct
    std::uint32_t bytes = 0;      ///< string: capacity with the final NUL
    std::uint32_t alignment = 1;  ///< of the first field, the largest of the block
    bool string = false;
  };
  void make_blocks();

  std::vector<Field> fields_;
  std::vector<Block> blocks_;
  std::size_t max_encoded_bytes_ = 0;
  std::size_t sample_bytes_ = 0;
};

}  // namespace crane::bus
