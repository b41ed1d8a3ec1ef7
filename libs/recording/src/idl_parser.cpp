#include <algorithm>
#include <charconv>
#include <utility>

#include "idl_tokens.hpp"
#include "schema_layout.hpp"

namespace crane::recording {
namespace {

constexpr std::uint32_t kMaxCount = 1U << 24U;  // largest array size and string bound
// A recording may come from anywhere: a short text must not describe a type that fills stack or memory. The
// types of crane.idl stay far below these limits.
constexpr std::size_t kMaxModules = 32, kMaxDepth = 32, kMaxFields = 4096, kMaxEnumerators = 256;
constexpr std::uint64_t kMaxValues =
    65'536;  // elementary values of one type, including the elements of arrays

const std::map<std::string, Kind, std::less<>> kPrimitives{{"boolean", Kind::boolean},
                                                           {"octet", Kind::uint8},
                                                           {"char", Kind::uint8},
                                                           {"int8", Kind::int8},
                                                           {"uint8", Kind::uint8},
                                                           {"int16", Kind::int16},
                                                           {"uint16", Kind::uint16},
                                                           {"int32", Kind::int32},
                                                           {"uint32", Kind::uint32},
                                                           {"int64", Kind::int64},
                                                           {"uint64", Kind::uint64},
                                                           {"short", Kind::int16},
                                                           {"long", Kind::int32},
                                                           {"long long", Kind::int64},
                                                           {"unsigned short", Kind::uint16},
                                                           {"unsigned long", Kind::uint32},
                                                           {"unsigned long long", Kind::uint64},
                                                           {"float", Kind::float32},
                                                           {"double", Kind::float64}};

/// Units in brackets at the beginning of a comment: "// [m, rad, m of cable] measured position" has m, rad,
/// m.
std::vector<std::string> units_in(std::string_view comment) {
  const auto open = comment.find_first_not_of("/< ");
  const auto close = comment.find(']');
  if (open == std::string_view::npos || comment[open] != '[' || close == std::string_view::npos) return {};
  std::vector<std::string> units;
  for (auto rest = comment.substr(open + 1, close - open - 1); !rest.empty();) {
    const auto comma = std::min(rest.find(','), rest.size());
    const auto item = rest.substr(std::min(rest.find_first_not_of(' '), comma), comma);
    units.emplace_back(item.substr(0, std::min(item.find_first_of(" ,"), item.size())));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return units;
}

/// Recursive-descent parser.
class Parser {
 public:
  Parser(std::string_view text, IdlTypes& types) : tokens_{tokens_of(text)}, types_{types} {}

  void run() {
    while (!peek().empty()) definition();
  }

 private:
  [[nodiscard]] std::string_view peek() const { return tokens_[at_].text; }
  [[nodiscard]] int line() const { return tokens_[at_].line; }
  [[noreturn]] void fail(const std::string& what) const { fail_at(line(), what); }

  std::string_view next() {
    if (peek().empty()) fail("the text ends inside a definition");
    return tokens_[at_++].text;
  }
  bool accept(std::string_view text) {
    if (peek() != text) return false;
    ++at_;
    return true;
  }
  void expect(std::string_view text) {
    if (accept(text)) return;
    const std::string found = peek().empty() ? "the end" : "'" + std::string{peek()} + "'";
    fail("expected '" + std::string{text} + "', found " + found);
  }
  std::string word() {
    const char first = peek().empty() ? '0' : peek().front();
    if (!(first == '_' || (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z')))
      fail("expected a name, found '" + std::string{peek()} + "'");
    return std::string{next()};
  }
  std::uint32_t count() {
    const std::string_view text = peek();
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value == 0 || value > kMaxCount)
      fail("expected a size from 1 to " + std::to_string(kMaxCount) + ", found '" + std::string{text} + "'");
    ++at_;
    return value;
  }

  void definition() {
    bool final = false;
    while (accept("@")) {
      if (word() != "final") fail("only @final and @key are supported");
      final = true;
    }
    if (accept("module")) return module();
    if (accept("enum")) return enumeration();
    if (accept("const")) return constant();
    if (!accept("struct"))
      fail("expected module, enum, const or struct, found '" + std::string{peek()} + "'");
    if (!final) fail("the struct must be @final: other layouts are not supported");
    structure();
  }

  /// const uint32 NAME = NUMBER;
  void constant() {
    expect("uint32");
    const std::string name = scoped(word());
    expect("=");
    types_.constants[name] = count();
    expect(";");
  }

  void module() {
    if (scope_.size() == kMaxModules)
      fail("more than " + std::to_string(kMaxModules) + " modules are nested");
    scope_.push_back(word());
    expect("{");
    while (!accept("}")) definition();
    expect(";");
    scope_.pop_back();
  }

  [[nodiscard]] std::string scoped(const std::string& name) const {
    std::string full;
    for (const std::string& each : scope_) full += each + "::";
    return full + name;
  }

  std::string new_name() {
    const int at = line();
    std::string name = scoped(word());
    if (types_.structures.contains(name) || types_.enumerations.contains(name))
      fail_at(at, name + " is defined twice");
    return name;
  }

  void enumeration() {
    Enumeration type{new_name(), {}};
    expect("{");
    do {
      if (type.values.size() == kMaxEnumerators)
        fail(type.name + " has more than " + std::to_string(kMaxEnumerators) + " values");
      type.values.push_back(word());
    } while (accept(","));
    expect("}");
    expect(";");
    std::string name = type.name;
    types_.enumerations.emplace(std::move(name), std::move(type));
  }

  void structure() {
    Structure type{.name = new_name()};
    expect("{");
    while (!accept("}")) fields(type);
    expect(";");
    types_.order.push_back(type.name);
    std::string name = type.name;
    types_.structures.emplace(std::move(name), std::move(type));
  }

  /// One member declaration: type name [n], name ...;
  void fields(Structure& of) {
    Field field;
    const std::size_t first = of.fields.size();
    while (accept("@")) {
      if (word() != "key") fail("only @final and @key are supported");
      field.key = true;
    }
    type_of(field);
    do {
      const int at = line();
      Field named = field;
      named.name = word();
      for (const Field& other : of.fields)
        if (other.name == named.name) fail_at(at, of.name + "." + named.name + " is defined twice");
      if (accept("[")) {
        named.is_array = true;
        named.count = count();
        expect("]");
        if (peek() == "[") fail("arrays of arrays are not supported");
      }
      add(of, std::move(named), at);
    } while (accept(","));
    expect(";");
    const auto units = units_in(tokens_[at_ - 1].comment);
    for (std::size_t i = first; i < of.fields.size(); ++i) of.fields[i].units = units;
  }

  static void add(Structure& of, Field field, int at) {
    const std::uint64_t each =
        field.structure == nullptr ? 1 : std::max<std::uint64_t>(field.structure->values, 1);
    of.values += field.count * each;
    if (field.structure != nullptr) of.depth = std::max(of.depth, field.structure->depth + 1);
    of.fields.push_back(std::move(field));
    if (of.depth > kMaxDepth)
      fail_at(at, of.name + " nests structures more than " + std::to_string(kMaxDepth) + " deep");
    if (of.values > kMaxValues)
      fail_at(at, of.name + " has more than " + std::to_string(kMaxValues) + " values");
    if (of.fields.size() > kMaxFields)
      fail_at(at, of.name + " has more than " + std::to_string(kMaxFields) + " fields");
  }

  void type_of(Field& field) {
    const int at = line();
    std::string name = word();
    if (name == "string") {
      field.kind = Kind::string;
      if (accept("<")) {
        field.max_length = count();
        expect(">");
      }
      return;
    }
    while ((name == "unsigned" || name == "long" || name == "unsigned long") &&
           (peek() == "long" || peek() == "short"))
      name += " " + word();
    if (const auto found = kPrimitives.find(name); found != kPrimitives.end()) {
      field.kind = found->second;
      return;
    }
    while (accept("::")) name += "::" + word();
    resolve(name, at, field);
  }

  /// Finds the definition of a name in the innermost enclosing module.
  void resolve(const std::string& name, int at, Field& field) const {
    for (std::size_t depth = scope_.size() + 1; depth-- > 0;) {
      std::string full;
      for (std::size_t i = 0; i < depth; ++i) full += scope_[i] + "::";
      full += name;
      if (const auto found = types_.structures.find(full); found != types_.structures.end()) {
        field.kind = Kind::structure;
        field.structure = &found->second;
        return;
      }
      if (const auto found = types_.enumerations.find(full); found != types_.enumerations.end()) {
        field.kind = Kind::enumeration;
        field.enumeration = &found->second;
        return;
      }
    }
    fail_at(at, "type " + name +
                    " is not known (supported: primitives, strings, enums and structs defined before)");
  }

  std::vector<Token> tokens_;
  IdlTypes& types_;
  std::size_t at_ = 0;
  std::vector<std::string> scope_;
};

}  // namespace

void IdlTypes::parse(std::string_view text) { Parser{text, *this}.run(); }

}  // namespace crane::recording
