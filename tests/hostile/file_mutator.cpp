#include "file_mutator.hpp"

#include <algorithm>
#include <array>

namespace crane::hostile {
namespace {

constexpr std::array<std::string_view, 24> kNumbers{"0",
                                                    "-0",
                                                    "-1",
                                                    "nan",
                                                    "inf",
                                                    "-inf",
                                                    "1e308",
                                                    "-1e308",
                                                    "1e-320",
                                                    "4.9e-324",
                                                    "1e999",
                                                    "2147483648",
                                                    "-2147483649",
                                                    "9223372036854775807",
                                                    "-9223372036854775808",
                                                    "18446744073709551616",
                                                    "0x7fffffffffffffff",
                                                    "0b1",
                                                    "1_000",
                                                    "+1",
                                                    "1.",
                                                    ".5",
                                                    "true",
                                                    "\"1\""};
constexpr std::array<std::string_view, 14> kTokens{
    "=", "[", "]", "{", "}", "\"", "'", "\\u", "\"\"\"", "[[a]]", "#", "\r\n", ",", "a.b.c = 1\n"};
constexpr std::array<std::string_view, 8> kBytes{
    std::string_view{"\0", 1}, "\xff",         "\xc0\xaf", "\xed\xa0\x80",
    "\xf4\x90\x80\x80",        "\xe2\x80\xae", "\x1b[2J",  "\xef\xbb\xbf"};

}  // namespace

std::string FileMutator::mutated(std::string text) {
  for (std::size_t n = 1 + below(3); n > 0; --n) mutate(text);
  return text;
}

void FileMutator::mutate(std::string& text) {
  if (text.empty()) text = "a";
  switch (below(16)) {
    case 0:
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:
      return replace_value(text);
    case 7:
    case 8:
    case 9:
      return repeat_line(text);
    case 10:
      return text.resize(below(text.size()));
    case 11:
      return static_cast<void>(text.insert(below(text.size()), kTokens[below(kTokens.size())]));
    case 12:
      return damage_bytes(text);
    case 13: {
      const auto at = below(text.size());
      return static_cast<void>(text.erase(at, below(60)));
    }
    case 14:
      return nest(text);
    default:
      if (below(20) == 0) return grow(text);
      return damage_bytes(text);
  }
}

/// Replaces the value after a random '=' (TOML), or a random cell (CSV).
void FileMutator::replace_value(std::string& text) {
  const char before = syntax_ == Syntax::toml ? '=' : ',';
  const auto at = text.find(before, below(text.size()));
  if (at == std::string::npos) return;
  const auto end =
      std::min(text.find_first_of(syntax_ == Syntax::toml ? "\n#,]}" : ",\n", at + 1), text.size());
  text.replace(at + 1, end - at - 1, kNumbers[below(kNumbers.size())]);
}

/// Repeats a line at another place, or removes it: keys occur twice, are missing, or are in another table.
void FileMutator::repeat_line(std::string& text) {
  const auto begin_of_line = [&text](std::size_t at) {
    const auto newline = text.rfind('\n', at);
    return newline == std::string::npos ? 0 : newline + 1;
  };
  const auto from = begin_of_line(below(text.size()));
  const auto length = std::min(text.find('\n', from), text.size() - 1) + 1 - from;
  const auto line = text.substr(from, length);
  if (below(3) == 0) return static_cast<void>(text.erase(from, length));
  text.insert(begin_of_line(below(text.size())), line);
}

/// Nests a value in arrays, inline tables or dotted keys, up to 20,000 deep.
void FileMutator::nest(std::string& text) {
  static constexpr std::array<std::size_t, 5> kDepths{2, 30, 300, 3000, 20'000};
  const auto depth = kDepths[below(8) > 0 ? below(3) : below(kDepths.size())];
  const std::string_view open = std::array<std::string_view, 4>{"[", "{a=", "a.", "\""}[below(4)];
  std::string nested;
  for (std::size_t i = 0; i < depth; ++i) nested += open;
  text.insert(text.find('\n', below(text.size())) == std::string::npos ? 0 : below(text.size()),
              "\n" + nested);
}

/// A huge array, line, number of lines, or number of columns.
void FileMutator::grow(std::string& text) {
  const std::size_t count = 1000U << below(6);
  std::string grown;
  switch (below(4)) {
    case 0:
      grown = "\nhuge = [";
      for (std::size_t i = 0; i < count; ++i) grown += "1,";
      grown += "]\n";
      break;
    case 1:
      grown = std::string(count * 10, 'x');
      break;
    case 2:
      for (std::size_t i = 0; i < count; ++i) grown += "k" + std::to_string(i) + " = 1\n";
      break;
    default:
      for (std::size_t i = 0; i < count; ++i) grown += "[[zone]]\n";
      break;
  }
  text.insert(below(text.size()), grown);
}

void FileMutator::damage_bytes(std::string& text) {
  if (below(2) == 0)
    text[below(text.size())] = static_cast<char>(below(256));
  else
    text.insert(below(text.size()), kBytes[below(kBytes.size())]);
}

}  // namespace crane::hostile
