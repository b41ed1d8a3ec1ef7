#pragma once
/// Random values for any topic, driven by the codec's list of fields.
#include <cstring>
#include <random>
#include <vector>

#include "crane/bus/cdr.hpp"

namespace crane::bus::testing {

using Random = std::mt19937_64;

inline void fill_field(const CdrCodec::Field& field, std::uint8_t* value, Random& random) {
  using Kind = CdrCodec::Field::Kind;
  if (field.kind == Kind::string) {
    std::memset(value, 0, field.count);
    const std::size_t length = random() % field.count;
    for (std::size_t i = 0; i < length; ++i) value[i] = static_cast<std::uint8_t>(1 + random() % 255);
    return;
  }
  for (std::uint32_t i = 0; i < field.count; ++i, value += field.size) {
    std::uint64_t bits = random();
    if (field.kind == Kind::boolean) bits &= 1;
    if (field.kind == Kind::enumeration) bits %= field.enum_max + 1;
    std::memcpy(value, &bits, field.size);  // floating: any bit pattern, also infinities and NaN
  }
}

/// Bytes of a C struct with random fields; padding is random too, as on a stack.
inline std::vector<std::uint8_t> random_sample(const CdrCodec& codec, Random& random) {
  std::vector<std::uint8_t> sample(codec.sample_bytes());
  for (auto& byte : sample) byte = static_cast<std::uint8_t>(random());
  for (const auto& field : codec.fields()) fill_field(field, sample.data() + field.offset, random);
  return sample;
}

inline std::vector<std::uint8_t> encoded(const CdrCodec& codec, const void* sample) {
  std::vector<std::uint8_t> bytes(codec.max_encoded_bytes());
  bytes.resize(codec.encode(sample, bytes));
  return bytes;
}

}  // namespace crane::bus::testing
