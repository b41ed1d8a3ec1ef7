#include "replay/difference.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "crane/bus/cdr.hpp"
#include "crane/recording/schema.hpp"

namespace crane::replay {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Field = bus::CdrCodec::Field;

/// The C struct of a sample; empty when the bytes are not a valid sample.
std::vector<std::uint8_t> struct_of(const bus::CdrCodec& codec, Bytes cdr) {
  std::vector<std::uint8_t> sample(codec.sample_bytes());
  const bool valid = cdr.size() >= bus::kEncapsulation_bytes &&
                     codec.decode(cdr.subspan(bus::kEncapsulation_bytes), false, sample.data());
  if (!valid) sample.clear();
  return sample;
}

/// @return -1 when the field is equal in both samples; otherwise the index of its first element that differs
int first_element(const Field& field, const std::vector<std::uint8_t>& a,
                  const std::vector<std::uint8_t>& b) {
  const auto* left = a.data() + field.offset;
  const auto* right = b.data() + field.offset;
  if (field.kind == Field::Kind::string)
    return std::strncmp(reinterpret_cast<const char*>(left), reinterpret_cast<const char*>(right),
                        field.count) == 0
               ? -1
               : 0;
  for (std::uint32_t i = 0; i < field.count; ++i)
    if (std::memcmp(left + i * field.size, right + i * field.size, field.size) != 0)
      return static_cast<int>(i);
  return -1;
}

/// 17 significant digits, which determine the double; for a NaN its bits.
std::string text_of(double value) {
  std::array<char, 64> text{};
  if (std::isnan(value))
    std::snprintf(text.data(), text.size(), "nan (0x%016llx)",
                  static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
  else
    std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

std::string text_of(const recording::Leaf& leaf, const Field& field, const std::uint8_t* element) {
  if (field.kind == Field::Kind::floating && field.size == sizeof(double)) {
    double value = 0;
    std::memcpy(&value, element, sizeof value);
    return text_of(value);
  }
  return leaf.second.is_string() ? leaf.second.get<std::string>() : leaf.second.dump();
}

const recording::Schema& own_schema() {
  static const recording::Schema schema{topics::idl_text()};
  return schema;
}

}  // namespace

std::optional<FieldDifference> first_difference(const topics::Description& topic, Bytes recorded,
                                                Bytes replayed) {
  if (std::ranges::equal(recorded, replayed)) return std::nullopt;
  const auto& codec = bus::CdrCodec::of(*topic.descriptor);
  const auto ours = struct_of(codec, replayed), theirs = struct_of(codec, recorded);
  if (ours.empty() || theirs.empty())
    return FieldDifference{"", theirs.empty() ? "not a valid sample" : "a valid sample",
                           ours.empty() ? "not a valid sample" : "a valid sample"};
  std::size_t leaf = 0;  // the schema lists every element, the codec every array
  for (const auto& field : codec.fields()) {
    const int element = first_element(field, theirs, ours);
    if (element >= 0) {
      const auto index = leaf + static_cast<std::size_t>(element);
      const auto at = field.offset + static_cast<std::size_t>(element) * field.size;
      const auto left = recording::flatten(own_schema().decode(topic.type, recorded)).at(index);
      const auto right = recording::flatten(own_schema().decode(topic.type, replayed)).at(index);
      return FieldDifference{left.first, text_of(left, field, theirs.data() + at),
                             text_of(right, field, ours.data() + at)};
    }
    leaf += field.kind == Field::Kind::string ? 1 : field.count;
  }
  return FieldDifference{"", "the same values, other padding", "the same values, other padding"};
}

}  // namespace crane::replay
