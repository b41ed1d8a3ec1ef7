#pragma once
/// Plain CDR (XCDR1, little endian) of a topic's C struct, driven by the op-codes idlc 0.10 puts in its
/// descriptor. One codec for Fast DDS, recordings, the CRC and the tools.
#include <cstdint>
#include <span>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

/// Layout of one type, compiled once at start-up.
class CdrCodec {
 public:
  /// One primitive, enum or string, or an array of one of the first two. Nested structs are flattened.
  struct Field {
    enum class Kind : std::uint8_t { number, floating, boolean, enumeration, string };
    std::uint32_t offset = 0;    ///< in the C struct
    std::uint32_t size = 0;      ///< of one element; string: 1
    std::uint32_t count = 1;     ///< elements; string: capacity with the final NUL
    std::uint32_t enum_max = 0;  ///< enumeration: largest value
    Kind kind = Kind::number;
    bool key = false;
    bool operator==(const Field&) const = default;
  };

  /// @throws Error naming type and field when the type uses a construct other than primitives, enums, bounded
  ///   strings, arrays of these, and nested @final structs, or a @key that is not one top-level primitive
  explicit CdrCodec(const dds_topic_descriptor_t& descriptor);

  /// The codec of a topic's type; compiled at the first call, then shared. Thread-safe.
  static const CdrCodec& of(const dds_topic_descriptor_t& descriptor);

  [[nodiscard]] std::size_t max_encoded_bytes() const;  ///< without the encapsulation header
  [[nodiscard]] std::size_t sample_bytes() const;       ///< sizeof the C struct
  [[nodiscard]] bool has_key() const;
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }  ///< in order of encoding
  /// Begins with crane::Header and ends with a uint32 that can hold the CRC.
  [[nodiscard]] bool is_sealable() const;

  /// @return bytes written (without encapsulation header), 0 when `out` is too small or a string unterminated
  [[nodiscard]] std::size_t encode(const void* sample, std::span<std::uint8_t> out) const;
  /// Bounds-checked; validates booleans, enums and strings. @return false: `sample` must not be used
  [[nodiscard]] bool decode(std::span<const std::uint8_t> in, bool big_endian, void* sample) const;
  /// Big-endian CDR of the key fields, for the RTPS key hash. @return bytes written
  [[nodiscard]] std::size_t encode_key(const void* sample, std::span<std::uint8_t> out) const;
  /// Reverse of encode_key() in either byte order; fields that are not keys stay as they are. @return false
  /// when `in` is too short
  [[nodiscard]] bool decode_key(std::span<const std::uint8_t> in, bool big_endian, void* sample) const;

 private:
  std::vector<Field> fields_;
  std::size_t max_encoded_bytes_ = 0;
  std::size_t sample_bytes_ = 0;
};

}  // namespace crane::bus
