#pragma once
/// Text that was written by another program, for a terminal, a page or a table.
#include <span>
#include <string>
#include <string_view>

namespace crane::fields {

/// Replaces what is no visible character, byte by byte: line breaks and tabs by a blank; other control
/// characters, characters that change the direction of the text, and bytes that are no UTF-8 by '?'. The
/// length stays the same. A text cannot steer a terminal, add a line to a table, or appear in another order.
/// @return true when the text has changed
bool make_printable(std::span<char> text);
/// The first `most` bytes of the text, made printable.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = std::string_view::npos);
/// Number of bytes of the longest beginning that has at most `most` bytes and ends with a whole character.
[[nodiscard]] std::size_t whole_characters(std::string_view text, std::size_t most);

}  // namespace crane::fields
