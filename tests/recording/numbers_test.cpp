/// Compares samples read as numbers with their JSON form, which another decoder produces. Checks the units of
/// the fields.
#include "crane/recording/numbers.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "../bus/random_sample.hpp"
#include "crane/fields/unit.hpp"
#include "crane/topics.hpp"

namespace crane::recording {
namespace {

using testing::HasSubstr;

std::vector<std::uint8_t> payload_of(const topics::Description& topic, bus::testing::Random& random) {
  const auto& codec = bus::CdrCodec::of(*topic.descriptor);
  const auto sample = bus::testing::random_sample(codec, random);
  std::vector<std::uint8_t> payload(4 + codec.max_encoded_bytes());
  payload[1] = 1;
  payload.resize(4 + codec.encode(sample.data(), std::span{payload}.subspan(4)));
  return payload;
}

double number_of(const nlohmann::ordered_json& value, const LeafType& leaf) {
  if (leaf.kind == Kind::string) return NAN;
  if (leaf.kind == Kind::boolean) return value.get<bool>() ? 1 : 0;
  if (leaf.kind == Kind::enumeration)
    return static_cast<double>(std::ranges::find(leaf.enumerators, value.get<std::string>()) -
                               leaf.enumerators.begin());
  return value.is_null() ? NAN : value.get<double>();
}

TEST(NumberReader, ReadsRandomSamplesOfEveryTopicAsTheJsonDecoderDoes) {
  constexpr unsigned kOfSamples = 20032;
  bus::testing::Random random{kOfSamples};
  const Schema schema{topics::idl_text()};
  for (const auto& topic : topics::kAll) {
    const auto reader = schema.number_reader(topic.type);
    const auto leaves = schema.leaves(topic.type);
    ASSERT_EQ(reader.size(), leaves.size());
    std::vector<double> values(reader.size());
    for (int round = 0; round < 50; ++round) {
      const auto payload = payload_of(topic, random);
      reader.read(payload, values);
      const auto expected = flatten(schema.decode(topic.type, payload));
      ASSERT_EQ(expected.size(), values.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(leaves[i].name, expected[i].first);
        const double wanted = number_of(expected[i].second, leaves[i]);
        if (std::isnan(wanted))
          ASSERT_TRUE(std::isnan(values[i])) << topic.name << ' ' << leaves[i].name << " seed " << kOfSamples;
        else
          ASSERT_EQ(values[i], wanted) << topic.name << ' ' << leaves[i].name << " seed " << kOfSamples;
      }
    }
  }
}

TEST(NumberReader, RefusesEveryTruncationAndBytesAtTheEnd) {
  bus::testing::Random random{20033};
  const Schema schema{topics::idl_text()};
  for (const auto& topic : topics::kAll) {
    const auto reader = schema.number_reader(topic.type);
    std::vector<double> values(reader.size());
    auto payload = payload_of(topic, random);
    for (std::size_t size = 0; size < payload.size(); ++size)
      EXPECT_THROW(reader.read(std::span{payload}.first(size), values), DecodeError)
          << topic.name << ' ' << size;
    payload.resize(payload.size() + 4);
    EXPECT_THAT([&] { reader.read(payload, values); },
                testing::ThrowsMessage<DecodeError>(HasSubstr("4 bytes remain after the last field")));
  }
}

TEST(NumberReader, ReadsBigEndian) {
  const Schema schema{"@final struct Point { boolean on; double x; short level; };"};
  std::vector<double> values(3);
  schema.number_reader("Point").read(
      std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0xC0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFE},
      values);
  EXPECT_THAT(values, testing::ElementsAre(1, -2, -2));
}

std::string unit_of(const Schema& schema, std::string_view type, std::string_view name) {
  for (const auto& leaf : schema.leaves(type))
    if (leaf.name == name) return leaf.unit;
  return "no such field";
}

TEST(Units, AreThoseOfTheNameOrOfTheCommentInBrackets) {
  const Schema schema{R"(
    @final struct Axis { double position;  // [m, rad, m of cable] measured
                         double speed_mps; };
    @final struct Crane { Axis axis[3];
                          double start[2], end[2];  // [m, rad]
                          double free;              // m, rad: no brackets
                          Axis one; };
  )"};
  EXPECT_EQ(unit_of(schema, "Crane", "axis[0].position"), "m");
  EXPECT_EQ(unit_of(schema, "Crane", "axis[1].position"), "rad");
  EXPECT_EQ(unit_of(schema, "Crane", "axis[2].position"), "m");
  EXPECT_EQ(unit_of(schema, "Crane", "axis[1].speed_mps"), "m/s");
  EXPECT_EQ(unit_of(schema, "Crane", "start[1]"), "rad");
  EXPECT_EQ(unit_of(schema, "Crane", "end[0]"), "m");
  EXPECT_EQ(unit_of(schema, "Crane", "free"), "");
}

/// Fields whose unit depends on the index of their array, by hand from crane.idl.
TEST(Units, OfTheTopicsDependOnTheAxisWhereTheAxesDiffer) {
  const Schema schema{topics::idl_text()};
  const std::vector<std::array<std::string, 3>> cases{{"crane::Reference", "axis[0].position", "m"},
                                                      {"crane::Reference", "axis[1].position", "rad"},
                                                      {"crane::Reference", "axis[1].speed", "rad/s"},
                                                      {"crane::Reference", "axis[2].speed", "m/s"},
                                                      {"crane::Reference", "axis[1].acceleration", "rad/s^2"},
                                                      {"crane::Reference", "start[1]", "rad"},
                                                      {"crane::Reference", "swing_rad[1]", "rad"},
                                                      {"crane::SupervisorStatus", "low_limit[1]", "rad"},
                                                      {"crane::SupervisorStatus", "high_limit[2]", "m"},
                                                      {"crane::SupervisorStatus", "homing_speed[1]", "rad/s"},
                                                      {"crane::SupervisorStatus", "move.target[0]", "m"},
                                                      {"crane::Twin", "column[0].residual", "m"},
                                                      {"crane::Twin", "column[3].band", "rad"},
                                                      {"crane::CraneState", "applied_v[1]", "V"},
                                                      {"crane::CraneState", "slew_speed_radps", "rad/s"},
                                                      {"crane::NodeStatus", "step_max_us", "us"},
                                                      {"crane::CraneState", "counts[1]", ""}};
  for (const auto& [type, name, unit] : cases)
    EXPECT_EQ(unit_of(schema, type, name), unit) << type << ' ' << name;
}

TEST(Units, OfEveryFieldAreInTheTableOfUnits) {
  const Schema schema{topics::idl_text()};
  for (const auto& topic : topics::kAll)
    for (const auto& leaf : schema.leaves(topic.type))
      if (!leaf.unit.empty()) {
        EXPECT_NE(fields::unit_with_symbol(leaf.unit), nullptr)
            << topic.type << ' ' << leaf.name << ' ' << leaf.unit;
      }
}

}  // namespace
}  // namespace crane::recording
