#include "toml_limits.hpp"

#include <algorithm>

namespace crane::configuration {
namespace {

/// Length of the string or comment at the beginning of `text`; 0: neither.
std::size_t opaque_length(std::string_view text) {
  if (text.front() == '#') return std::min(text.find('\n'), text.size());
  if (text.front() != '"' && text.front() != '\'') return 0;
  const char quote = text.front();
  const bool long_string = text.size() >= 3 && text[1] == quote && text[2] == quote;
  for (std::size_t i = long_string ? 3 : 1; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (!long_string) {
      if (text[i] == quote) return i + 1;
      if (text[i] == '\n') return i;
    } else if (text.substr(i, 3) == std::string(3, quote)) {
      i += 3;
      for (int more = 0; more < 2 && i < text.size() && text[i] == quote; ++more) ++i;
      return i;
    }
  }
  return text.size();
}

}  // namespace

std::optional<TomlExcess> excess_of(std::string_view text) {
  if (text.size() > kLongestToml_bytes)
    return TomlExcess{1,
                      "the file must be at most " + std::to_string(kLongestToml_bytes >> 20U) + " MB long"};
  constexpr std::string_view kEndsKey = "=,[]{}\n";
  int line = 1, dots = 0;
  while (!text.empty()) {
    auto length = opaque_length(text);
    if (length == 0) {
      length = 1;
      if (kEndsKey.find(text.front()) != std::string_view::npos) dots = 0;
      if (text.front() == '.' && ++dots >= kMostKeyParts)
        return TomlExcess{line, "a key must have at most " + std::to_string(kMostKeyParts) + " parts"};
    }
    line += static_cast<int>(std::ranges::count(text.substr(0, length), '\n'));
    text.remove_prefix(length);
  }
  return std::nullopt;
}

}  // namespace crane::configuration
