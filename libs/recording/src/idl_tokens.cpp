#include "idl_tokens.hpp"

#include <algorithm>
#include <cctype>

#include "crane/recording/schema.hpp"

namespace crane::recording {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Length of the white space or comment at the start of `text`; 0 when there is none.
std::size_t blank_length(std::string_view text, int line) {
  if (std::isspace(static_cast<unsigned char>(text.front())) != 0) return 1;
  if (text.starts_with("//")) return std::min(text.find('\n'), text.size());
  if (!text.starts_with("/*")) return 0;
  const std::size_t end = text.find("*/", 2);
  if (end == std::string_view::npos) fail_at(line, "the comment has no end");
  return end + 2;
}

/// Length of the token at the start of `text`; 0 when IDL has no such token.
std::size_t token_length(std::string_view text) {
  if (is_word(text.front())) {
    const auto end = std::find_if_not(text.begin(), text.end(), is_word);
    return static_cast<std::size_t>(end - text.begin());
  }
  if (text.starts_with("::")) return 2;
  constexpr std::string_view kPunctuation = "{}<>[];:,@=()\"";
  return kPunctuation.find(text.front()) == std::string_view::npos ? 0 : 1;
}

}  // namespace

void fail_at(int line, const std::string& what) {
  throw SchemaError("line " + std::to_string(line) + ": " + what);
}

std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> tokens;
  int line = 1;
  while (!text.empty()) {
    std::size_t length = blank_length(text, line);
    if (length == 0) {
      length = token_length(text);
      if (length == 0) fail_at(line, std::string{"unexpected '"} + text.front() + "'");
      tokens.push_back({text.substr(0, length), line});
    } else if (text.starts_with("//") && !tokens.empty() && tokens.back().line == line) {
      tokens.back().comment = text.substr(0, length);
    }
    line +=
        static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length), '\n'));
    text.remove_prefix(length);
  }
  tokens.push_back({{}, line});
  return tokens;
}

}  // namespace crane::recording
