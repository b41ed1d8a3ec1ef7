#include "field_names.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace crane::bus {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::size_t kHashBytes = 15;           // EK_COMPLETE and 14 bytes of hash
constexpr std::uint8_t kCompleteHash = 0xf2;     // DDS-XTypes 1.3, EK_COMPLETE
constexpr std::uint8_t kStructure = 0x51;        // TK_STRUCTURE
constexpr std::size_t kObjectToNameLength = 12;  // bytes from EK_COMPLETE of a type without base to its name

std::size_t align4(std::size_t at) { return (at + 3) & ~std::size_t{3}; }

std::optional<std::uint32_t> number(Bytes bytes, std::size_t at) {
  std::uint32_t value = 0;
  if (at + sizeof value > bytes.size()) return std::nullopt;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// @return the length-prefixed identifier at `at`; nothing when there is none
std::optional<std::string_view> identifier(Bytes bytes, std::size_t at) {
  const auto length = number(bytes, at);
  if (!length || *length < 2 || *length > 256 || at + 4 + *length > bytes.size()) return std::nullopt;
  const std::string_view text{reinterpret_cast<const char*>(bytes.data()) + at + 4, *length - 1};
  const auto allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == ':'; };
  if (bytes[at + 3 + *length] != 0 || !std::all_of(text.begin(), text.end(), allowed)) return std::nullopt;
  return text;
}

bool is_structure(Bytes map, std::size_t at) {
  return at + 1 < map.size() && map[at] == kCompleteHash && map[at + 1] == kStructure;
}

/// Offset of the complete type object of the structure called `name`.
std::optional<std::size_t> find_by_name(Bytes map, std::string_view name) {
  for (std::size_t at = 0; at + kObjectToNameLength < map.size(); at += 4)
    if (is_structure(map, at) && identifier(map, at + kObjectToNameLength) == name) return at;
  return std::nullopt;
}

/// Offset of the complete structure whose type identifier is `hash`.
std::optional<std::size_t> find_by_hash(Bytes map, Bytes hash) {
  for (std::size_t at = 0; at + 24 < map.size(); at += 4)
    if (std::equal(hash.begin(), hash.end(), map.begin() + static_cast<std::ptrdiff_t>(at)) &&
        is_structure(map, at + 20))  // identifier 15 + padding 1 + object length 4
      return at + 20;
  return std::nullopt;
}

/// Offset and bytes of one member of the structure whose type object begins at `object`.
struct Member {
  std::size_t begin = 0, end = 0;
};
std::optional<Member> find_member(Bytes map, std::size_t object, std::size_t index) {
  const auto name = identifier(map, object + kObjectToNameLength);
  if (!name) return std::nullopt;
  std::size_t at = align4(object + kObjectToNameLength + 4 + name->size() + 1);
  const auto count = number(map, at + 4);
  if (!count || index >= *count) return std::nullopt;
  at += 8;
  for (std::size_t i = 0;; ++i) {
    const auto length = number(map, at);
    if (!length || at + 4 + *length > map.size()) return std::nullopt;
    if (i == index) return Member{at + 4, at + 4 + *length};
    at = align4(at + 4 + *length);
  }
}

}  // namespace

std::string field_name(const dds_topic_descriptor_t& descriptor, std::span<const std::size_t> path) {
  const Bytes map{descriptor.type_mapping.data, descriptor.type_mapping.sz};
  std::string text;
  bool named = false;
  auto object = find_by_name(map, descriptor.m_typename);
  for (const std::size_t index : path) {
    if (!object && named) break;  // the member is not a structure
    text += text.empty() ? "" : ".";
    const auto member = object ? find_member(map, *object, index) : std::nullopt;
    object.reset();
    std::optional<std::string_view> name;
    // A member consists of id (4 bytes), flags (2), type identifier and name. The name is the first valid
    // identifier.
    for (std::size_t at = member ? member->begin + 8 : 0; member && at < member->end && !name; at += 4) {
      name = identifier(map.first(member->end), at);
      if (name) break;
    }
    named = name.has_value();
    text += named ? std::string{*name} : "member " + std::to_string(index);
    for (std::size_t at = member ? member->begin + 6 : 0; member && at + kHashBytes <= member->end; ++at) {
      if (map[at] == kCompleteHash) object = find_by_hash(map, map.subspan(at, kHashBytes));
      if (object) break;
    }
  }
  return text;
}

}  // namespace crane::bus
