#include "crane/recording/numbers.hpp"

#include <bit>
#include <limits>

#include "leaf_walk.hpp"

namespace crane::recording {
namespace {

constexpr std::size_t kEncapsulation_bytes = 4;
constexpr std::size_t kMostPadding_bytes = 3;
constexpr std::size_t kTextLength_bytes = 4;

template <class T>
double integer(std::uint64_t raw) {
  return static_cast<double>(static_cast<T>(raw));
}
double float32(std::uint64_t raw) {
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
}
double float64(std::uint64_t raw) { return std::bit_cast<double>(raw); }

/// Plain CDR: every primitive is aligned to its size, relative to the end of the encapsulation header.
class PayloadCursor {
 public:
  PayloadCursor(std::string_view type, std::span<const std::uint8_t> payload) : type_{type} {
    if (payload.size() < kEncapsulation_bytes || payload[0] != 0 || payload[1] > 1) fail("is not plain CDR");
    big_endian_ = payload[1] == 0;
    body_ = payload.subspan(kEncapsulation_bytes);
  }

  std::uint64_t raw(std::size_t bytes) {
    at_ = (at_ + bytes - 1) / bytes * bytes;
    need(bytes);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value |= std::uint64_t{body_[at_ + (big_endian_ ? bytes - 1 - i : i)]} << (8 * i);
    at_ += bytes;
    return value;
  }

  void skip_text() {
    const auto size = raw(kTextLength_bytes);
    need(size);
    at_ += size;
  }

  void finish() const {
    if (body_.size() - at_ > kMostPadding_bytes)
      fail(std::to_string(body_.size() - at_) + " bytes remain after the last field");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw DecodeError(std::string{type_} + ": " + what);
  }
  void need(std::size_t bytes) const {
    if (at_ > body_.size() || bytes > body_.size() - at_)
      fail("ends after " + std::to_string(body_.size()) + " of at least " + std::to_string(at_ + bytes) +
           " bytes");
  }

  std::string_view type_;
  std::span<const std::uint8_t> body_;
  std::size_t at_ = 0;
  bool big_endian_ = false;
};

}  // namespace

void NumberReader::read(std::span<const std::uint8_t> payload, std::span<double> values) const {
  PayloadCursor cursor{type_, payload};
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    if (steps_[i].bytes == 0) {
      cursor.skip_text();
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
  const auto step_of = [](Kind kind) -> NumberReader::Step {
    switch (kind) {
      case Kind::boolean:
      case Kind::uint8:
        return {1, integer<std::uint8_t>};
      case Kind::int8:
        return {1, integer<std::int8_t>};
      case Kind::int16:
        return {2, integer<std::int16_t>};
      case Kind::uint16:
        return {2, integer<std::uint16_t>};
      case Kind::int32:
        return {4, integer<std::int32_t>};
      case Kind::enumeration:
      case Kind::uint32:
        return {4, integer<std::uint32_t>};
      case Kind::int64:
        return {8, integer<std::int64_t>};
      case Kind::uint64:
        return {8, integer<std::uint64_t>};
      case Kind::float32:
        return {4, float32};
      case Kind::float64:
        return {8, float64};
      case Kind::string:
      case Kind::structure:  // for_each_leaf() visits the members of the structure instead
        break;
    }
    return {};
  };
  for_each_leaf(structure_named(*types_, type), [&](const std::string&, const Field& field, std::uint32_t) {
    reader.steps_.push_back(step_of(field.kind));
  });
  return reader;
}

}  // namespace crane::recording
