#pragma once
/// Types of an IDL text, in the form that the decoder uses.
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "crane/recording/kind.hpp"

namespace crane::recording {

struct Enumeration {
  std::string name;
  std::vector<std::string> values;
};

struct Structure;

struct Field {
  std::string name;
  Kind kind = Kind::uint8;
  bool is_array = false;
  std::uint32_t count = 1;       ///< elements of the array
  std::uint32_t max_length = 0;  ///< string: maximum length without the terminator; 0: unbounded
  bool key = false;
  std::vector<std::string> units;  ///< by index of the innermost array; empty: the name ends in the unit
  const Enumeration* enumeration = nullptr;
  const Structure* structure = nullptr;
};

struct Structure {
  std::string name;  ///< full name: "crane::Header"
  std::vector<Field> fields{};
  std::uint64_t values = 0;  ///< elementary values, including the elements of arrays
  std::size_t depth = 1;     ///< 1: no field is a structure
};

struct IdlTypes {
  std::map<std::string, Structure, std::less<>> structures;  ///< stable addresses; fields point to them
  std::map<std::string, Enumeration, std::less<>> enumerations;
  std::map<std::string, std::uint32_t, std::less<>> constants;  ///< by full name
  std::vector<std::string> order;  ///< names of the structures in the order of the text

  /// @throws SchemaError
  void parse(std::string_view text);
};

}  // namespace crane::recording
