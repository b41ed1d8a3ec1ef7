#include "crane/recording/schema.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <functional>

#include "crane/topics.hpp"

namespace crane::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Payload = std::vector<std::uint8_t>;

constexpr const char* kIdl = R"(
/* comment
   over lines */
module outer {
  enum Colour { RED, GREEN };   // comment
  module inner {
    @final struct Point { double x, y; @key uint8 id; };
  };
  @final struct Shape {
    boolean visible;
    inner::Point corner[2];
    outer::Colour colour;
    string<3> name;
    unsigned long long area;
    float ratio;
    short level;
  };
};
)";

Payload shape_little_endian() {
  // clang-format off
  return {0, 1, 0, 0,                                                         // encapsulation: little endian
          1, 0, 0, 0, 0, 0, 0, 0,                                             // visible, padding to 8
          0, 0, 0, 0, 0, 0, 0xF0, 0x3F, 0, 0, 0, 0, 0, 0, 0, 0xC0,            // corner[0]: 1.0, -2.0
          7, 0, 0, 0, 0, 0, 0, 0,                                             // id 7, padding
          0, 0, 0, 0, 0, 0, 0, 0x40, 0, 0, 0, 0, 0, 0, 0, 0,                  // corner[1]: 2.0, 0.0
          8, 0, 0, 0,                                                         // id 8, padding to 4
          1, 0, 0, 0,                                                         // GREEN
          3, 0, 0, 0, 'a', 'b', 0, 0,                                         // "ab", padding
          0, 0, 0, 0, 0, 0, 0, 0x80,                                          // area 2^63
          0, 0, 0, 0x3F,                                                      // ratio 0.5
          0xFE, 0xFF, 0, 0};                                                  // level -2, trailing padding
  // clang-format on
}

TEST(Schema, DecodesEveryKindOfFieldOfALittleEndianPayload) {
  const auto sample = Schema{kIdl}.decode("outer::Shape", shape_little_endian());
  EXPECT_EQ(sample.dump(),
            R"({"visible":true,"corner":[{"x":1.0,"y":-2.0,"id":7},{"x":2.0,"y":0.0,"id":8}],)"
            R"("colour":"GREEN","name":"ab","area":9223372036854775808,"ratio":0.5,"level":-2})");
}

TEST(Schema, TextsWithOtherCommentsDefineEqualTypes) {
  EXPECT_TRUE(
      define_equal_types("struct A { double x; // m\n};", "// A point\nstruct A {\n  double x;\n};\n"));
  EXPECT_FALSE(define_equal_types("struct A { double x; };", "struct A { double y; };"));
  EXPECT_FALSE(define_equal_types("struct A { double x; };", "struct A { double x; double y; };"));
  EXPECT_FALSE(define_equal_types("struct A { double x; };", "struct A \x01"));
}

TEST(Schema, DecodesBigEndian) {
  const Payload payload{0, 0, 0, 0, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0, 0xC0, 0, 0, 0, 0, 0, 0, 0, 9};
  EXPECT_EQ(Schema{kIdl}.decode("outer::inner::Point", payload).dump(), R"({"x":1.0,"y":-2.0,"id":9})");
}

TEST(Schema, NamesTheLeavesAsFlattenDoes) {
  const Schema schema{kIdl};
  const std::vector<Leaf> leaves = flatten(schema.decode("outer::Shape", shape_little_endian()));
  std::vector<std::string> names;
  for (const Leaf& leaf : leaves) names.push_back(leaf.first);
  EXPECT_THAT(names, ElementsAre("visible", "corner[0].x", "corner[0].y", "corner[0].id", "corner[1].x",
                                 "corner[1].y", "corner[1].id", "colour", "name", "area", "ratio", "level"));
  EXPECT_EQ(schema.columns("outer::Shape"), names);
  EXPECT_EQ(leaves[4].second, 2.0);
  EXPECT_EQ(leaves[7].second, "GREEN");
}

TEST(Schema, ReplacesInvisibleText) {
  const Schema schema{"@final struct Note { string text; };"};
  const auto sample = schema.decode("Note", Payload{0, 1, 0, 0, 4, 0, 0, 0, 'a', 0xC3, 0x1B, 0});
  EXPECT_EQ(sample.dump(), "{\"text\":\"a??\"}");
}

std::string decode_error(const Schema& schema, const std::string& type, const Payload& payload) {
  try {
    (void)schema.decode(type, payload);
  } catch (const DecodeError& error) {
    return error.what();
  }
  return "no DecodeError";
}

TEST(Schema, NamesTheFieldWhereAPayloadIsMalformed) {
  const Schema schema{kIdl};
  const auto error_with = [&](std::size_t at, std::uint8_t value) {
    Payload payload = shape_little_endian();
    payload[at] = value;
    return decode_error(schema, "outer::Shape", payload);
  };
  EXPECT_EQ(error_with(0, 5), "outer::Shape: is not plain CDR");
  EXPECT_EQ(error_with(1, 7), "outer::Shape: is not plain CDR");
  EXPECT_EQ(error_with(4, 2), "outer::Shape.visible: is 2, a boolean is 0 or 1");
  EXPECT_EQ(error_with(56, 2), "outer::Shape.colour: is 2, which outer::Colour does not have");
  EXPECT_EQ(error_with(66, 'c'), "outer::Shape.name: is not terminated");
  EXPECT_EQ(error_with(60, 5), "outer::Shape.name: has 4 characters, at most 3 are allowed");
  EXPECT_THAT(error_with(63, 0xFF), HasSubstr("outer::Shape.name: ends after"));
  EXPECT_EQ(decode_error(schema, "outer::Shape", {0, 1}), "outer::Shape: has no encapsulation header");
}

TEST(Schema, RefusesEveryPayloadThatIsCutOrTooLong) {
  const Schema schema{kIdl};
  const Payload whole = shape_little_endian();
  for (std::size_t size = 0; size + 2 < whole.size(); ++size)
    EXPECT_THROW(
        (void)schema.decode("outer::Shape", Payload(whole.begin(), whole.begin() + static_cast<long>(size))),
        DecodeError)
        << size;
  Payload longer = whole;
  longer.resize(whole.size() + 4);
  EXPECT_THAT(decode_error(schema, "outer::Shape", longer), HasSubstr("bytes remain after the last field"));
}

TEST(Schema, NamesAnUnknownType) {
  EXPECT_THROW((void)Schema{kIdl}.decode("outer::Circle", Payload{0, 1, 0, 0}), std::out_of_range);
  EXPECT_THROW((void)Schema{kIdl}.columns("Shape"), std::out_of_range);
}

std::string schema_error(const std::string& idl) {
  try {
    const Schema schema{idl};
  } catch (const SchemaError& error) {
    return error.what();
  }
  return "no SchemaError";
}

TEST(Schema, NamesTheLineOfAnUnsupportedConstruct) {
  EXPECT_EQ(schema_error("@final struct A {\n  uint8 a\n};"), "line 3: expected ';', found '}'");
  EXPECT_EQ(schema_error("\nstruct A { uint8 a; };"),
            "line 2: the struct must be @final: other layouts are not supported");
  EXPECT_EQ(schema_error("@mutable struct A { uint8 a; };"), "line 1: only @final and @key are supported");
  EXPECT_THAT(schema_error("@final struct A { B b; };"), HasSubstr("line 1: type B is not known"));
  EXPECT_EQ(schema_error("@final struct A { uint8 a; uint8 a; };"), "line 1: A.a is defined twice");
  EXPECT_EQ(schema_error("enum A { X };\nenum A { X };"), "line 2: A is defined twice");
  EXPECT_EQ(schema_error("@final struct A { uint8 a[2][2]; };"),
            "line 1: arrays of arrays are not supported");
  EXPECT_THAT(schema_error("@final struct A { uint8 a[0]; };"), HasSubstr("line 1: expected a size from 1"));
  EXPECT_THAT(schema_error("@final struct A { uint8 a[99999999999]; };"),
              HasSubstr("line 1: expected a size"));
  EXPECT_THAT(schema_error("@final struct A { sequence<uint8> a; };"),
              HasSubstr("type sequence is not known"));
  EXPECT_EQ(schema_error("@final struct A {"), "line 1: expected a name, found ''");
  EXPECT_EQ(schema_error("module m {"), "line 1: expected module, enum, const or struct, found ''");
  EXPECT_EQ(schema_error("/* no end"), "line 1: the comment has no end");
  EXPECT_EQ(schema_error("union U;"), "line 1: expected module, enum, const or struct, found 'union'");
  EXPECT_EQ(schema_error("#pragma x"), "line 1: unexpected '#'");
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

/// Texts of a few bytes per level that describe an unbounded depth or an unbounded number of values.
TEST(Schema, RefusesATextThatWouldFillStackOrMemory) {
  EXPECT_THAT(schema_error(repeated("module m {\n", 500'000)), HasSubstr("line 33: more than 32 modules"));
  std::string doubled = "@final struct S0 { double a; };\n";
  for (int i = 1; i < 64; ++i)
    doubled += "@final struct S" + std::to_string(i) + " { S" + std::to_string(i - 1) + " a; S" +
               std::to_string(i - 1) + " b; };\n";
  EXPECT_THAT(schema_error(doubled), HasSubstr("line 18: S17 has more than 65536 values"));
  std::string deep = "@final struct S0 { double a; };\n";
  for (int i = 1; i < 60'000; ++i)
    deep += "@final struct S" + std::to_string(i) + " { S" + std::to_string(i - 1) + " a; };\n";
  EXPECT_THAT(schema_error(deep), HasSubstr("line 33: S32 nests structures more than 32 deep"));
  EXPECT_THAT(schema_error("@final struct A { uint8 a[65536]; };\n@final struct B { A a[2]; };"),
              HasSubstr("line 2: B has more than 65536 values"));
  EXPECT_THAT(schema_error("@final struct E { };\n@final struct A { E a[65536]; E b; };"),
              HasSubstr("line 2: A has more than 65536 values"));
  std::string fields = "@final struct A {\n", values = "enum A { A0";
  for (int i = 0; i < 5000; ++i)
    fields += "uint8 f" + std::to_string(i) + ";\n", values += ", B" + std::to_string(i);
  EXPECT_THAT(schema_error(fields + "};"), HasSubstr("A has more than 4096 fields"));
  EXPECT_THAT(schema_error(values + "};"), HasSubstr("A has more than 256 values"));
}

TEST(Schema, ReadsConstants) {
  const Schema schema{"const uint32 A = 3; module m { const uint32 B = 4; @final struct S { uint8 a; }; };"};
  EXPECT_EQ(schema.constant("A"), 3U);
  EXPECT_EQ(schema.constant("m::B"), 4U);
  EXPECT_EQ(schema.constant("B"), std::nullopt);
  EXPECT_THAT(schema_error("const uint32 A = x;"), HasSubstr("line 1: expected a size"));
}

TEST(Schema, SurvivesEveryPrefixOfTheTopicsText) {
  const std::string idl{topics::idl_text()};
  for (std::size_t size = 0; size < idl.size(); size += 13) {
    try {
      const Schema schema{idl.substr(0, size)};
    } catch (const SchemaError&) {
      continue;  // refused, as expected; only a prefix that ends between definitions is valid
    }
  }
}

TEST(Schema, KnowsTheTypeOfEveryTopic) {
  const Schema schema{topics::idl_text()};
  for (const topics::Description& topic : topics::kAll) {
    EXPECT_TRUE(schema.contains(topic.type)) << topic.type;
    EXPECT_EQ(schema.columns(topic.type).front(), "header.tick");
    EXPECT_EQ(schema.columns(topic.type).back(), "crc32c");
  }
}

}  // namespace
}  // namespace crane::recording
