#include "tokens.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "crane/fields/nearest_name.hpp"

namespace crane::expression {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// Field names have dots and indices: "reference.axis[0].position".
std::size_t name_length(std::string_view text) {
  std::size_t at = 0;
  const auto part = [&](auto belongs) {
    while (at < text.size() && belongs(text[at])) ++at;
  };
  part([](char c) { return is_letter(c) || is_digit(c) || c == '.' || c == '[' || c == ']'; });
  return at;
}

bool is_word(std::string_view word) {
  constexpr std::array<std::string_view, 3> kWords{"and", "or", "not"};
  return std::ranges::find(kWords, word) != kWords.end();
}

/// Length of a unit such as "deg", "m/s", "m/s^2". A slash belongs to the unit when a known unit results.
std::size_t unit_length(std::string_view text) {
  std::size_t letters = 0;
  while (letters < text.size() && (is_letter(text[letters]) || (letters > 0 && is_digit(text[letters]))))
    ++letters;
  std::size_t longest = letters;
  for (const auto& unit : fields::units())
    if (unit.symbol.size() > longest && text.starts_with(unit.symbol) &&
        (unit.symbol.size() == text.size() || !is_letter(text[unit.symbol.size()])))
      longest = unit.symbol.size();
  return longest;
}

std::string known_units() {
  std::string known;
  for (const auto& unit : fields::units()) known += (known.empty() ? "" : ", ") + std::string{unit.symbol};
  return known;
}

class Scanner {
 public:
  Scanner(std::string_view text, std::vector<Problem>& problems) : text_{text}, problems_{problems} {}

  std::vector<Token> run() {
    for (skip_blanks(); at_ < text_.size(); skip_blanks()) next();
    tokens_.push_back({.kind = Token::Kind::end, .text = {}, .position = text_.size()});
    return std::move(tokens_);
  }

 private:
  [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }

  void next() {
    const char c = text_[at_];
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
    if (is_letter(c)) return take(Token::Kind::name, name_length(rest()));
    for (const std::string_view sign : {"<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "(", ")", ","})
      if (rest().starts_with(sign)) return take(Token::Kind::sign, sign.size());
    std::size_t length = 1;  // number of bytes of the character, which may be outside ASCII
    while (at_ + length < text_.size() && (static_cast<unsigned char>(text_[at_ + length]) & 0xC0U) == 0x80U)
      ++length;
    const std::string hint = c == '='   ? "; a comparison is written =="
                             : c == '&' ? "; write and"
                             : c == '|' ? "; write or"
                             : c == '!' ? "; write not"
                                        : "; permitted are names, numbers, ( ) , + - * / < <= > >= == !=";
    problems_.push_back({at_, "'" + std::string{rest().substr(0, length)} + "' has no meaning here" + hint});
    at_ += length;
  }

  void take(Token::Kind kind, std::size_t length) {
    tokens_.push_back({.kind = kind, .text = rest().substr(0, length), .position = at_});
    at_ += length;
  }

  void number() {
    const std::size_t begin = at_;
    Token token{.kind = Token::Kind::number, .text = {}, .position = begin};
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), token.value);
    if (error != std::errc{} || !std::isfinite(token.value)) {
      problems_.push_back({begin, "the number is out of range"});
      token.value = 1;
    }
    at_ = static_cast<std::size_t>(end - text_.data());
    const std::size_t behind_number = at_;
    skip_blanks();
    const auto length = unit_length(rest());
    const auto symbol = rest().substr(0, length);
    if (length == 0 || is_word(symbol)) {
      at_ = behind_number;
    } else {
      at_ += length;
      token.unit = fields::unit_with_symbol(symbol);
      if (token.unit == nullptr) unknown_unit(symbol);
      token.value *= token.unit == nullptr ? 1 : token.unit->factor;
    }
    token.text = text_.substr(begin, at_ - begin);
    tokens_.push_back(token);
  }

  void unknown_unit(std::string_view symbol) {
    problems_.push_back(
        {at_ - symbol.size(), "unknown unit '" + std::string{symbol} + "'; the units are " + known_units()});
  }

  std::string_view text_;
  std::vector<Problem>& problems_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<Token> tokens_of(std::string_view text, std::vector<Problem>& problems) {
  return Scanner{text, problems}.run();
}

}  // namespace crane::expression
