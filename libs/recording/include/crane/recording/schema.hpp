#pragma once
/// Decodes plain CDR with the IDL text of a recording. Tools can therefore read types that they do not
/// contain. Supported IDL: modules, uint32 constants, enums, @final structs, @key, nested structs,
/// one-dimensional arrays, bounded and unbounded strings, primitives, comments.
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "crane/recording/kind.hpp"

namespace crane::recording {

/// The IDL is malformed or not supported: "line 12: expected ';', found '}'".
class SchemaError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// The payload does not match the type: "crane::Reply.client: ends after 20 of 24 bytes".
class DecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct IdlTypes;
class NumberReader;
class ColumnTable;

/// Type of an elementary value.
struct LeafType {
  std::string name;  ///< "axis[1].position"
  Kind kind = Kind::float64;
  /// "m", "rad/s"; empty: none. The name of the field ends in the unit; if the unit depends on an index, the
  /// comment of the field declares it (idl/README.md).
  std::string unit;
  std::string enumeration;               ///< name of its type; empty for other kinds
  std::vector<std::string> enumerators;  ///< by number; empty for other kinds
};

/// True when two IDL texts define the same types: they differ only in comments and white space, or not at
/// all.
[[nodiscard]] bool define_equal_types(std::string_view a, std::string_view b);

class Schema {
 public:
  /// @throws SchemaError
  explicit Schema(std::string_view idl_text);

  /// Value of a constant, "crane::MESSAGES_VERSION"; nothing when the text does not define it.
  [[nodiscard]] std::optional<std::uint32_t> constant(std::string_view name) const;
  [[nodiscard]] bool contains(std::string_view type) const;  ///< "crane::CraneState"
  [[nodiscard]] std::vector<std::string> types() const;      ///< structs in the order of the text

  /// Decodes a sample to JSON: fields in order, enums by name, nested structs as objects, arrays as arrays.
  /// @param payload  plain CDR, little or big endian, with the 4-byte encapsulation header; up to 3 bytes of
  ///   padding are permitted at the end
  /// @throws DecodeError, std::out_of_range for an unknown type
  [[nodiscard]] nlohmann::ordered_json decode(std::string_view type,
                                              std::span<const std::uint8_t> payload) const;

  /// Names of all elementary values: "header.tick", "applied_v[0]". @throws std::out_of_range for an unknown
  /// type
  [[nodiscard]] std::vector<std::string> columns(std::string_view type) const;
  /// Types of all elementary values, in the order of columns(). @throws std::out_of_range for an unknown type
  [[nodiscard]] std::vector<LeafType> leaves(std::string_view type) const;
  /// Reader of samples of this type as numbers (numbers.hpp). @throws std::out_of_range for an unknown type
  [[nodiscard]] NumberReader number_reader(std::string_view type) const;
  /// Empty table for samples of this type (columns.hpp). @throws std::out_of_range for an unknown type
  [[nodiscard]] ColumnTable column_table(std::string_view type) const;

 private:
  std::shared_ptr<const IdlTypes> types_;
};

/// Name and value of an elementary value: number, boolean or string.
using Leaf = std::pair<std::string, nlohmann::ordered_json>;
/// Elementary values of a decoded sample, in the order of columns().
[[nodiscard]] std::vector<Leaf> flatten(const nlohmann::ordered_json& sample);

}  // namespace crane::recording
