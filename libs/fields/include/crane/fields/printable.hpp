#pragma once
/// Makes text from another program safe to show on a terminal, a page or in a table.
#include <span>
#include <string>
#include <string_view>

namespace crane::fields {

/// Replaces every byte of an invisible character: line breaks and tabs by a blank; other control characters,
/// characters that change the direction of the text, and bytes that are not valid UTF-8 by '?'. The length
/// does not change. The resulting text cannot control a terminal, add a line to a table, or appear in another
/// order.
/// @return true when the text has changed
bool make_printable(std::span<char> text);
/// The longest prefix of whole characters with at most `most` bytes, made printable.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = std::string_view::npos);
/// Length in bytes of the longest prefix that has at most `most` bytes and ends with a complete character.
[[nodiscard]] std::size_t whole_characters(std::string_view text, std::size_t most);

}  // namespace crane::fields
