#include "cdr_compiler.hpp"

#include <dds/ddsc/dds_opcodes.h>
#include <dds/ddsc/dds_public_impl.h>

#include <algorithm>
#include <span>
#include <string>

#include "crane/bus/bus.hpp"
#include "field_names.hpp"

namespace crane::bus {
namespace {

using Field = CdrCodec::Field;
using Kind = CdrCodec::Field::Kind;

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

}  // namespace

std::vector<Field> fields_of(const dds_topic_descriptor_t& descriptor) {
  std::vector<Field> fields;
  Compiler{descriptor, fields}.members(descriptor.m_ops, 0);
  return fields;
}

}  // namespace crane::bus
