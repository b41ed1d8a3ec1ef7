#pragma once
/// Mutations of the text of a TOML or CSV file that keep most of its structure, so that many files reach the
/// checks behind the parser. Random numbers come from a seed.
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

namespace crane::hostile {

enum class Syntax : std::uint8_t { toml, csv };

class FileMutator {
 public:
  FileMutator(std::uint64_t seed, Syntax syntax) : random_{seed}, syntax_{syntax} {}
  /// One to three mutations of `text`.
  [[nodiscard]] std::string mutated(std::string text);
  [[nodiscard]] std::size_t below(std::size_t n) { return random_() % n; }

 private:
  void mutate(std::string& text);
  void replace_value(std::string& text);
  void repeat_line(std::string& text);
  void nest(std::string& text);
  void grow(std::string& text);
  void damage_bytes(std::string& text);

  std::mt19937_64 random_;
  Syntax syntax_;
};

}  // namespace crane::hostile
