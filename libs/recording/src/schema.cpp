#include "crane/recording/schema.hpp"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "crane/fields/printable.hpp"
#include "idl_tokens.hpp"
#include "leaf_walk.hpp"
#include "payload_cursor.hpp"

namespace crane::recording {
namespace {

using nlohmann::ordered_json;

/// Decodes a sample to JSON.
class Decoder {
 public:
  Decoder(const Structure& type, std::span<const std::uint8_t> payload)
      : path_{type.name}, cursor_{path_, payload} {}

  ordered_json structure(const Structure& type) {
    ordered_json object = ordered_json::object();
    for (const Field& field : type.fields) {
      const std::size_t length = path_.size();
      path_ += "." + field.name;
      object[field.name] = field.is_array ? array(field) : value(field);
      path_.resize(length);
    }
    return object;
  }

  void finish() const { cursor_.finish(); }

 private:
  ordered_json array(const Field& field) {
    ordered_json list = ordered_json::array();
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const std::size_t length = path_.size();
      path_ += "[" + std::to_string(i) + "]";
      list.push_back(value(field));
      path_.resize(length);
    }
    return list;
  }

  ordered_json value(const Field& field) {
    switch (field.kind) {
      case Kind::boolean:
        return boolean();
      case Kind::int8:
        return static_cast<std::int8_t>(number<std::uint8_t>());
      case Kind::uint8:
        return number<std::uint8_t>();
      case Kind::int16:
        return static_cast<std::int16_t>(number<std::uint16_t>());
      case Kind::uint16:
        return number<std::uint16_t>();
      case Kind::int32:
        return static_cast<std::int32_t>(number<std::uint32_t>());
      case Kind::uint32:
        return number<std::uint32_t>();
      case Kind::int64:
        return static_cast<std::int64_t>(number<std::uint64_t>());
      case Kind::uint64:
        return number<std::uint64_t>();
      case Kind::float32:
        return std::bit_cast<float>(number<std::uint32_t>());
      case Kind::float64:
        return std::bit_cast<double>(number<std::uint64_t>());
      case Kind::string:
        return text(field.max_length);
      case Kind::enumeration:
        return enumerator(*field.enumeration);
      case Kind::structure:
        return structure(*field.structure);
    }
    cursor_.fail("has an unknown kind");
  }

  template <class T>
  T number() {
    return static_cast<T>(cursor_.raw(sizeof(T)));
  }

  bool boolean() {
    const auto byte = number<std::uint8_t>();
    if (byte > 1) cursor_.fail("is " + std::to_string(byte) + ", a boolean is 0 or 1");
    return byte == 1;
  }

  std::string enumerator(const Enumeration& type) {
    const auto index = number<std::uint32_t>();
    if (index >= type.values.size())
      cursor_.fail("is " + std::to_string(index) + ", which " + type.name + " does not have");
    return type.values[index];
  }

  std::string text(std::uint32_t max_length) {
    const auto bytes = cursor_.text();
    if (!bytes.ends_with('\0')) cursor_.fail("is not terminated");
    std::string value(bytes.begin(), bytes.end() - 1);
    if (max_length > 0 && value.size() > max_length)
      cursor_.fail("has " + std::to_string(value.size()) + " characters, at most " +
                   std::to_string(max_length) + " are allowed");
    fields::make_printable(value);  // the file may come from any program
    return value;
  }

  std::string path_;  ///< of the member that is read
  PayloadCursor cursor_;
};

void flatten_into(const ordered_json& value, const std::string& name, std::vector<Leaf>& leaves) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      flatten_into(member, name.empty() ? key : std::string{name}.append(".").append(key), leaves);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      flatten_into(value[i], name + "[" + std::to_string(i) + "]", leaves);
  } else {
    leaves.emplace_back(name, value);
  }
}

}  // namespace

bool define_equal_types(std::string_view a, std::string_view b) {
  if (a == b) return true;
  try {
    return std::ranges::equal(tokens_of(a), tokens_of(b), {}, &Token::text, &Token::text);
  } catch (const SchemaError&) {
    return false;
  }
}

Schema::Schema(std::string_view idl_text) {
  auto types = std::make_shared<IdlTypes>();
  types->parse(idl_text);
  types_ = std::move(types);
}

std::optional<std::uint32_t> Schema::constant(std::string_view name) const {
  const auto found = types_->constants.find(name);
  if (found == types_->constants.end()) return std::nullopt;
  return found->second;
}

bool Schema::contains(std::string_view type) const { return types_->structures.contains(type); }

std::vector<std::string> Schema::types() const { return types_->order; }

ordered_json Schema::decode(std::string_view type, std::span<const std::uint8_t> payload) const {
  const Structure& structure = structure_named(*types_, type);
  Decoder decoder{structure, payload};
  ordered_json sample = decoder.structure(structure);
  decoder.finish();
  return sample;
}

std::vector<Leaf> flatten(const ordered_json& sample) {
  std::vector<Leaf> leaves;
  flatten_into(sample, "", leaves);
  return leaves;
}

}  // namespace crane::recording
