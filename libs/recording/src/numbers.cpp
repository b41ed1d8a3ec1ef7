#include "crane/recording/numbers.hpp"

#include <bit>
#include <limits>

#include "leaf_walk.hpp"
#include "payload_cursor.hpp"

namespace crane::recording {
namespace {

template <class T>
double integer(std::uint64_t raw) {
  return static_cast<double>(static_cast<T>(raw));
}
double float32(std::uint64_t raw) {
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
}
double float64(std::uint64_t raw) { return std::bit_cast<double>(raw); }

/// @return conversion of the bytes of a value to a number; null for a type that is not a number
double (*conversion_of(Kind kind))(std::uint64_t) {
  switch (kind) {
    case Kind::boolean:
    case Kind::uint8:
      return integer<std::uint8_t>;
    case Kind::int8:
      return integer<std::int8_t>;
    case Kind::int16:
      return integer<std::int16_t>;
    case Kind::uint16:
      return integer<std::uint16_t>;
    case Kind::int32:
      return integer<std::int32_t>;
    case Kind::enumeration:
    case Kind::uint32:
      return integer<std::uint32_t>;
    case Kind::int64:
      return integer<std::int64_t>;
    case Kind::uint64:
      return integer<std::uint64_t>;
    case Kind::float32:
      return float32;
    case Kind::float64:
      return float64;
    case Kind::string:
    case Kind::structure:  // for_each_leaf() visits the members of the structure instead
      break;
  }
  return nullptr;
}

}  // namespace

void NumberReader::read(std::span<const std::uint8_t> payload, std::span<double> values) const {
  PayloadCursor cursor{type_, payload};
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    if (steps_[i].bytes == 0) {
      (void)cursor.text();
      values[i] = std::numeric_limits<double>::quiet_NaN();
    } else {
      values[i] = steps_[i].value(cursor.raw(steps_[i].bytes));
    }
  }
  cursor.finish();
}

NumberReader Schema::number_reader(std::string_view type) const {
  NumberReader reader;
  reader.type_ = type;
  for_each_leaf(structure_named(*types_, type), [&](const std::string&, const Field& field, std::uint32_t) {
    reader.steps_.push_back({size_of(field.kind), conversion_of(field.kind)});
  });
  return reader;
}

}  // namespace crane::recording
