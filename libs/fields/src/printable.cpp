#include "crane/fields/printable.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace crane::fields {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// The first character of a text.
struct Character {
  std::size_t bytes = 0;  ///< 0: the text does not begin with valid UTF-8
  std::uint32_t code = 0;
};

/// Decodes UTF-8 by RFC 3629, which forbids overlong forms, surrogates and codes above U+10FFFF.
Character first_of(std::span<const char> text) {
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return {1, lead};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC0 || lead > 0xF7 || text.size() < bytes) return {};
  std::uint32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!continues(text[i])) return {};
    code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kLeast.at(bytes) || surrogate || code > 0x10FFFF) return {};
  return {bytes, code};
}

/// Control characters, marks and overrides of direction, separators of lines, and invisible characters.
bool is_invisible(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) || code == 0x61C ||
         code == 0xFEFF;
}

}  // namespace

bool make_printable(std::span<char> text) {
  bool changed = false;
  while (!text.empty()) {
    const auto character = first_of(text);
    const auto bytes = std::max<std::size_t>(character.bytes, 1);
    if (character.bytes == 0 || is_invisible(character.code)) {
      const bool blank = character.code == '\n' || character.code == '\t' || character.code == '\r';
      std::ranges::fill(text.first(bytes), blank ? ' ' : '?');
      changed = true;
    }
    text = text.subspan(bytes);
  }
  return changed;
}

std::string printable(std::string_view text, std::size_t most) {
  std::string result{text.substr(0, whole_characters(text, most))};
  make_printable(result);
  return result;
}

std::size_t whole_characters(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text.size();
  while (most > 0 && continues(text[most])) --most;
  return most;
}

}  // namespace crane::fields
