#pragma once
/// Layout of IDL types, read from the IDL text a recording carries, and decoding of plain CDR with it: for
/// tools that meet types they were not compiled with. Subset: modules, enums, @final structs, @key, nested
/// structs, one-dimensional arrays, bounded and unbounded strings, primitives, comments.
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crane::recording {

/// IDL outside the subset or malformed: "line 12: expected ';', found '}'".
class SchemaError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// Payload that is not what the type says: "crane::Reply.client: ends after 20 of 24 bytes".
class DecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct IdlTypes;

class Schema {
 public:
  /// @throws SchemaError
  explicit Schema(std::string_view idl_text);

  [[nodiscard]] bool contains(std::string_view type) const;  ///< "crane::CraneState"
  [[nodiscard]] std::vector<std::string> types() const;      ///< structs in the order of the text

  /// Fields in order; enums by name, nested structs as objects, arrays as arrays. `payload` begins with the
  /// 4-byte encapsulation header: plain CDR, little or big endian. Trailing padding up to 3 bytes is allowed.
  /// @throws DecodeError, std::out_of_range for an unknown type
  [[nodiscard]] nlohmann::ordered_json decode(std::string_view type,
                                              std::span<const std::uint8_t> payload) const;

  /// Names of the leaves: "header.tick", "applied_v[0]". @throws std::out_of_range for an unknown type
  [[nodiscard]] std::vector<std::string> columns(std::string_view type) const;

 private:
  std::shared_ptr<const IdlTypes> types_;
};

/// A leaf and its value: number, boolean or string.
using Leaf = std::pair<std::string, nlohmann::ordered_json>;
/// Leaves of a decoded sample, in the order of columns().
[[nodiscard]] std::vector<Leaf> flatten(const nlohmann::ordered_json& sample);

}  // namespace crane::recording
