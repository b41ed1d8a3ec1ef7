#pragma once
/// Types of the fields of an IDL text.
#include <cstddef>
#include <cstdint>

namespace crane::recording {

enum class Kind : std::uint8_t {
  boolean,  ///< uint8 with the values 0 and 1
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  enumeration,  ///< uint32: number of the enumerator
  structure     ///< consists of fields
};

/// Size of a value, bytes; 0 for strings and structures.
[[nodiscard]] constexpr std::size_t size_of(Kind kind) {
  switch (kind) {
    case Kind::boolean:
    case Kind::int8:
    case Kind::uint8:
      return 1;
    case Kind::int16:
    case Kind::uint16:
      return 2;
    case Kind::int32:
    case Kind::uint32:
    case Kind::float32:
    case Kind::enumeration:
      return 4;
    case Kind::int64:
    case Kind::uint64:
    case Kind::float64:
      return 8;
    case Kind::string:
    case Kind::structure:
      break;
  }
  return 0;
}

}  // namespace crane::recording
