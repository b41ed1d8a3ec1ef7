#pragma once
/// Words, numbers and punctuation of an IDL text, comments left out.
#include <string>
#include <string_view>
#include <vector>

namespace crane::recording {

struct Token {
  std::string_view text;  ///< empty: end of the text
  int line = 1;
};

/// The last token is the end of the text. @throws SchemaError for a character IDL does not know
[[nodiscard]] std::vector<Token> tokens_of(std::string_view idl_text);

[[noreturn]] void fail_at(int line, const std::string& what);

}  // namespace crane::recording
