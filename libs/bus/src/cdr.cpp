#include "crane/bus/cdr.hpp"

#include <dds/ddsc/dds_opcodes.h>
#include <dds/ddsc/dds_public_impl.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "crane/bus/bus.hpp"
#include "crane/fields/printable.hpp"
#include "field_names.hpp"

namespace crane::bus {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the codec writes CDR_LE in the byte order of the host");
static_assert(sizeof(bool) == 1);

using Field = CdrCodec::Field;
using Kind = CdrCodec::Field::Kind;

constexpr std::uint32_t align(std::uint32_t at, std::uint32_t size) { return (at + size - 1) & ~(size - 1); }
constexpr std::uint32_t alignment(const Field& field) { return field.kind == Kind::string ? 4 : field.size; }

std::uint32_t width(dds_stream_typecode code) {
  switch (code) {
    case DDS_OP_VAL_BLN:
    case DDS_OP_VAL_1BY:
      return 1;
    case DDS_OP_VAL_2BY:
      return 2;
    case DDS_OP_VAL_4BY:
    case DDS_OP_VAL_ENU:
      return 4;
    case DDS_OP_VAL_8BY:
      return 8;
    default:
      return 0;
  }
}

const char* construct(dds_stream_typecode code) {
  switch (code) {
    case DDS_OP_VAL_STR:
      return "unbounded string";
    case DDS_OP_VAL_SEQ:
      return "sequence";
    case DDS_OP_VAL_BSQ:
      return "bounded sequence";
    case DDS_OP_VAL_UNI:
      return "union";
    case DDS_OP_VAL_BMK:
      return "bit mask";
    case DDS_OP_VAL_ARR:
      return "array of arrays";
    default:
      return "unknown construct";
  }
}

/// Reads the op-codes of a type and lists its fields.
class Compiler {
 public:
  Compiler(const dds_topic_descriptor_t& descriptor, std::vector<Field>& fields)
      : descriptor_{descriptor}, fields_{fields} {}

  void members(const std::uint32_t* op, std::uint32_t base) {
    path_.push_back(0);
    for (; *op != DDS_OP_RTS; ++path_.back()) op += member(op, base);
    path_.pop_back();
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw Error{
        "type " + std::string{descriptor_.m_typename} + ", field " + field_name(descriptor_, path_) + ": " +
        problem +
        "; a topic may use numbers, booleans, enums, bounded strings, arrays of these and nested @final "
        "structs"};
  }

  void refuse_attributes(std::uint32_t op) const {
    if (DDS_OP(op) != DDS_OP_ADR) {
      const auto path = std::span{path_}.first(path_.size() - 1);
      const std::string where = path.empty() ? "" : ", field " + field_name(descriptor_, path);
      throw Error{"type " + std::string{descriptor_.m_typename} + where + ": the struct is not @final"};
    }
    const std::uint32_t flags = DDS_OP_FLAGS(op);
    if ((flags & DDS_OP_FLAG_OPT) != 0) refuse("@optional");
    if ((op & DDS_OP_FLAG_EXT) != 0) refuse("@external");
    if ((flags & DDS_OP_FLAG_BASE) != 0) refuse("inheritance");
    const auto type = DDS_OP_TYPE(op);
    if ((flags & DDS_OP_FLAG_KEY) != 0 && (path_.size() > 1 || width(type) == 0))
      refuse("@key that is not one top-level number or enum");
  }

  void add(std::uint32_t op, dds_stream_typecode type, std::uint32_t offset, std::uint32_t count,
           std::uint32_t enum_max) {
    Field field{.offset = offset, .size = width(type), .count = count, .enum_max = 0};
    if (type == DDS_OP_VAL_BLN) field.kind = Kind::boolean;
    if (type == DDS_OP_VAL_BST) {
      field.kind = Kind::string;
      field.size = 1;
    }
    if (type == DDS_OP_VAL_ENU) {
      if (DDS_OP_TYPE_SZ(op) != 4) refuse("enum with @bit_bound");
      field.kind = Kind::enumeration;
      field.enum_max = enum_max;
    }
    const bool number = type == DDS_OP_VAL_4BY || type == DDS_OP_VAL_8BY;
    if (number && (DDS_OP_FLAGS(op) & DDS_OP_FLAG_FP) != 0) field.kind = Kind::floating;
    field.key = path_.size() == 1 && (DDS_OP_FLAGS(op) & DDS_OP_FLAG_KEY) != 0;
    if (field.key && std::any_of(fields_.begin(), fields_.end(), [](const Field& f) { return f.key; }))
      refuse("second @key");
    fields_.push_back(field);
  }

  /// @return length of the instruction in words
  std::uint32_t member(const std::uint32_t* op, std::uint32_t base) {
    refuse_attributes(*op);
    const auto type = DDS_OP_TYPE(*op);
    const std::uint32_t offset = base + op[1];
    switch (type) {
      case DDS_OP_VAL_1BY:
      case DDS_OP_VAL_2BY:
      case DDS_OP_VAL_4BY:
      case DDS_OP_VAL_8BY:
      case DDS_OP_VAL_BLN:
        return add(*op, type, offset, 1, 0), 2;
      case DDS_OP_VAL_ENU:
        return add(*op, type, offset, 1, op[2]), 3;
      case DDS_OP_VAL_BST:
        return add(*op, type, offset, op[2], 0), 3;
      case DDS_OP_VAL_ARR:
        return array(op, offset);
      case DDS_OP_VAL_EXT: {
        members(op + DDS_OP_ADR_JSR(op[2]), offset);
        const std::uint32_t next = DDS_OP_ADR_JMP(op[2]);
        return next != 0 ? next : 3;
      }
      default:
        refuse(construct(type));
    }
  }

  std::uint32_t array(const std::uint32_t* op, std::uint32_t offset) {
    const auto element = DDS_OP_SUBTYPE(*op);
    const std::uint32_t count = op[2];
    if (element == DDS_OP_VAL_STU) {
      const std::uint32_t stride = op[4];
      for (std::uint32_t i = 0; i < count; ++i) members(op + DDS_OP_ADR_JSR(op[3]), offset + i * stride);
      const std::uint32_t next = DDS_OP_ADR_JMP(op[3]);
      return next != 0 ? next : 5;
    }
    if (element == DDS_OP_VAL_BST) {
      const std::uint32_t capacity = op[4];
      for (std::uint32_t i = 0; i < count; ++i) add(*op, element, offset + i * capacity, capacity, 0);
      return 5;
    }
    if (width(element) == 0) refuse(std::string{"array of "} + construct(element));
    const bool enumeration = element == DDS_OP_VAL_ENU;
    add(*op, element, offset, count, enumeration ? op[3] : 0);
    return enumeration ? 4 : 3;
  }

  const dds_topic_descriptor_t& descriptor_;
  std::vector<Field>& fields_;
  std::vector<std::size_t> path_;
};

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
  Compiler{descriptor, fields_}.members(descriptor.m_ops, 0);
  std::uint32_t end = 0;
  for (const Field& field : fields_) {  // strings vary in length: assume the largest padding
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
  // Called for every sample. A cache per thread avoids a lock.
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
