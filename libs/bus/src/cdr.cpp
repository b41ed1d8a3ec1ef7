#include "crane/bus/cdr.hpp"

#include <dds/ddsc/dds_public_impl.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "cdr_compiler.hpp"
#include "crane/bus/bus.hpp"
#include "crane/fields/printable.hpp"

namespace crane::bus {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the codec writes CDR_LE in the byte order of the host");
static_assert(sizeof(bool) == 1);

using Field = CdrCodec::Field;
using Kind = CdrCodec::Field::Kind;

constexpr std::uint32_t align(std::uint32_t at, std::uint32_t size) { return (at + size - 1) & ~(size - 1); }
constexpr std::uint32_t alignment(const Field& field) { return field.kind == Kind::string ? 4 : field.size; }

bool valid(const Field& field, const std::uint8_t* value) {
  if (field.kind == Kind::boolean)
    return std::all_of(value, value + field.count, [](std::uint8_t b) { return b <= 1; });
  if (field.kind != Kind::enumeration) return true;
  for (std::uint32_t i = 0; i < field.count; ++i) {
    std::uint32_t number = 0;
    std::memcpy(&number, value + std::size_t{4} * i, 4);
    if (number > field.enum_max) return false;
  }
  return true;
}

void reverse_elements(const Field& field, std::uint8_t* value) {
  if (field.size == 1) return;
  for (std::uint32_t i = 0; i < field.count; ++i, value += field.size)
    std::reverse(value, value + field.size);
}

/// Reads a bounded string and sets the rest of the field to zero. @return offset of its end in `in`; 0 when
/// it is malformed
std::uint32_t decode_string(const Field& field, std::span<const std::uint8_t> in, std::uint32_t at,
                            bool big_endian, std::uint8_t* value) {
  if (at + 4 > in.size()) return 0;
  std::uint32_t length = 0;
  std::memcpy(&length, in.data() + at, 4);
  if (big_endian) length = __builtin_bswap32(length);
  at += 4;
  if (length < 1 || length > field.count || length > in.size() - at) return 0;
  const std::uint8_t* text = in.data() + at;
  if (text[length - 1] != 0 || std::memchr(text, 0, length - 1) != nullptr) return 0;
  std::memcpy(value, text, length);
  std::memset(value + length, 0, field.count - length);
  return at + length;
}

}  // namespace

CdrCodec::CdrCodec(const dds_topic_descriptor_t& descriptor) : sample_bytes_{descriptor.m_size} {
  fields_ = fields_of(descriptor);
  std::uint32_t end = 0;
  for (const Field& field : fields_) {  // the length of strings varies: the sum assumes the largest padding
    if (field.kind == Kind::string)
      end = align(end, 4) + 4 + field.count + 7;
    else
      end = align(end, field.size) + field.size * field.count;
  }
  max_encoded_bytes_ = end;
  make_blocks();
}

void CdrCodec::make_blocks() {
  for (const Field& field : fields_) {
    const bool string = field.kind == Kind::string;
    const std::uint32_t bytes = field.size * field.count;
    if (!blocks_.empty() && !string && !blocks_.back().string) {
      Block& last = blocks_.back();
      if (field.offset == last.offset + last.bytes && field.size <= last.alignment) {
        last.bytes += bytes;
        continue;
      }
    }
    blocks_.push_back({field.offset, bytes, alignment(field), string});
  }
}

const CdrCodec& CdrCodec::of(const dds_topic_descriptor_t& descriptor) {
  // This function is called for every sample. A cache per thread avoids a lock.
  thread_local std::vector<std::pair<const dds_topic_descriptor_t*, const CdrCodec*>> known;
  for (const auto& [key, codec] : known)
    if (key == &descriptor) return *codec;
  static std::mutex mutex;
  static std::unordered_map<const dds_topic_descriptor_t*, std::unique_ptr<const CdrCodec>> compiled;
  const std::lock_guard lock{mutex};
  auto& codec = compiled[&descriptor];
  if (!codec) codec = std::make_unique<const CdrCodec>(descriptor);
  known.emplace_back(&descriptor, codec.get());
  return *codec;
}

std::size_t CdrCodec::max_encoded_bytes() const { return max_encoded_bytes_; }
std::size_t CdrCodec::sample_bytes() const { return sample_bytes_; }
bool CdrCodec::has_key() const {
  return std::any_of(fields_.begin(), fields_.end(), [](const Field& field) { return field.key; });
}
bool CdrCodec::has_texts() const {
  return std::any_of(blocks_.begin(), blocks_.end(), [](const Block& block) { return block.string; });
}

bool CdrCodec::is_sealable() const {
  static const CdrCodec header{crane_Header_desc};
  const std::size_t n = header.fields_.size();
  if (fields_.size() <= n || !std::equal(header.fields_.begin(), header.fields_.end(), fields_.begin()))
    return false;
  const Field& last = fields_.back();
  return last.kind == Kind::number && last.size == 4 && last.count == 1 && !last.key;
}

std::size_t CdrCodec::encode(const void* sample, std::span<std::uint8_t> out) const {
  const auto* base = static_cast<const std::uint8_t*>(sample);
  std::uint32_t at = 0;
  for (const Block& block : blocks_) {
    const std::uint8_t* value = base + block.offset;
    const std::uint32_t begin = align(at, block.alignment);
    std::uint32_t bytes = block.bytes;
    if (block.string) {
      bytes = static_cast<std::uint32_t>(strnlen(reinterpret_cast<const char*>(value), block.bytes)) + 1;
      if (bytes > block.bytes) return 0;
    }
    const std::uint32_t prefix = block.string ? 4 : 0;
    if (begin + prefix + bytes > out.size()) return 0;
    if (begin != at) std::memset(out.data() + at, 0, begin - at);
    if (block.string) std::memcpy(out.data() + begin, &bytes, 4);
    std::memcpy(out.data() + begin + prefix, value, bytes);
    at = begin + prefix + bytes;
  }
  return at;
}

bool CdrCodec::decode(std::span<const std::uint8_t> in, bool big_endian, void* sample) const {
  auto* base = static_cast<std::uint8_t*>(sample);
  std::uint32_t at = 0;
  for (const Field& field : fields_) {
    std::uint8_t* value = base + field.offset;
    at = align(at, alignment(field));
    if (field.kind == Kind::string) {
      at = decode_string(field, in, at, big_endian, value);
      if (at == 0) return false;
      continue;
    }
    const std::uint32_t bytes = field.size * field.count;
    if (at > in.size() || bytes > in.size() - at) return false;
    std::memcpy(value, in.data() + at, bytes);
    if (big_endian) reverse_elements(field, value);
    if (!valid(field, value)) return false;
    at += bytes;
  }
  return in.size() - at < 4;  // RTPS pads a payload to a multiple of four
}

bool CdrCodec::make_texts_printable(void* sample) const {
  bool changed = false;
  for (const Block& block : blocks_) {
    if (!block.string) continue;
    auto* const text = static_cast<char*>(sample) + block.offset;
    changed = fields::make_printable({text, strnlen(text, block.bytes)}) || changed;
  }
  return changed;
}

std::size_t CdrCodec::encode_key(const void* sample, std::span<std::uint8_t> out) const {
  const auto* base = static_cast<const std::uint8_t*>(sample);
  for (const Field& field : fields_) {
    if (!field.key) continue;
    if (field.size > out.size()) return 0;
    std::memcpy(out.data(), base + field.offset, field.size);
    reverse_elements(field, out.data());
    return field.size;
  }
  return 0;
}

bool CdrCodec::decode_key(std::span<const std::uint8_t> in, bool big_endian, void* sample) const {
  auto* base = static_cast<std::uint8_t*>(sample);
  for (const Field& field : fields_) {
    if (!field.key) continue;
    if (field.size > in.size()) return false;
    std::memcpy(base + field.offset, in.data(), field.size);
    if (big_endian) reverse_elements(field, base + field.offset);
    return valid(field, base + field.offset);
  }
  return true;
}

}  // namespace crane::bus
