#pragma once
/// Splits an IDL text into tokens: words, numbers and punctuation. A comment belongs to the token before it
/// on its line.
#include <string>
#include <string_view>
#include <vector>

namespace crane::recording {

struct Token {
  std::string_view text;  ///< empty: end of the text
  int line = 1;
  std::string_view comment{};  ///< "// ..." behind the token, on the same line; empty: none
};

/// The last token is an empty end token. @throws SchemaError for a character that IDL does not have
[[nodiscard]] std::vector<Token> tokens_of(std::string_view idl_text);

[[noreturn]] void fail_at(int line, const std::string& what);

}  // namespace crane::recording
