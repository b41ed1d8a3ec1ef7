// Columns with exact values.
#include "crane/recording/columns.hpp"

#include <gmock/gmock.h>

#include <cstring>

#include "crane/recording/loss.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::ElementsAre;

template <class T>
std::vector<T> values_of(const Column& column) {
  std::vector<T> values(column.bytes.size() / sizeof(T));
  std::memcpy(values.data(), column.bytes.data(), column.bytes.size());
  return values;
}

/// Little-endian samples of the type "a::Sample".
ColumnTable table_of(const std::string& members, const std::vector<std::vector<std::uint8_t>>& samples) {
  auto table =
      Schema{
          "module a { enum E { ZERO, ONE }; @final struct Inner { double position; uint8 flags; }; "
          "@final struct Sample { " +
          members + " }; };"}
          .column_table("a::Sample");
  for (auto body : samples) {
    body.insert(body.begin(), {0, 1, 0, 0});
    Message message;
    message.data = body;
    table.add(message);
  }
  return table;
}

TEST(Columns, JoinTheElementsOfArraysOfStructures) {
  const auto table = table_of("Inner axis[2]; boolean valid; E kind;", {});
  ASSERT_EQ(table.columns().size(), 4U);
  EXPECT_EQ(table.columns()[0].name, "axis.position");
  EXPECT_EQ(table.columns()[0].width, 2U);
  EXPECT_TRUE(table.columns()[0].array);
  EXPECT_EQ(table.columns()[1].name, "axis.flags");
  EXPECT_EQ(table.columns()[2].kind, Kind::boolean);
  EXPECT_FALSE(table.columns()[2].array);
  EXPECT_THAT(table.columns()[3].enumerators, ElementsAre("ZERO", "ONE"));
}

TEST(Columns, KeepSampleAfterSampleInTheOrderOfTheElements) {
  const auto table = table_of("int16 volts[3];", {{1, 0, 2, 0, 0xFF, 0xFF}, {4, 0, 5, 0, 6, 0}});
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_THAT(values_of<std::int16_t>(table.columns()[0]), ElementsAre(1, 2, -1, 4, 5, 6));
}

TEST(Columns, KeepIntegersThatADoubleCannotHold) {
  const TemporaryDirectory directory;
  constexpr std::int64_t kOdd = (std::int64_t{1} << 60) + 1;
  {
    McapWriter writer{directory / "a.mcap"};
    const auto channel = add_loss_channel(writer);
    for (const auto* topic : {"crane/state", ""})
      write_loss(
          writer, channel,
          {.topic = topic, .cause = LossCause::wrong_crc, .samples = 7, .from_ns = -kOdd, .until_ns = kOdd});
    writer.close();
  }
  McapReader reader{directory / "a.mcap"};
  auto tables = column_tables(reader, "");
  ASSERT_EQ(tables.size(), 1U);
  auto& table = tables.begin()->second;
  reader.for_each({}, [&](const Message& message) {
    table.add(message);
    return true;
  });
  EXPECT_THAT(table.columns()[0].texts, ElementsAre("crane/state", ""));
  EXPECT_THAT(values_of<std::uint32_t>(table.columns()[1]), ElementsAre(2U, 2U));
  EXPECT_THAT(values_of<std::int64_t>(table.columns()[3]), ElementsAre(-kOdd, -kOdd));
  EXPECT_THAT(values_of<std::int64_t>(table.columns()[4]), ElementsAre(kOdd, kOdd));
  EXPECT_THAT(table.log_times_ns(), ElementsAre(kOdd, kOdd));
  table.clear_rows();
  EXPECT_EQ(table.rows(), 0U);
  EXPECT_EQ(table.bytes(), 0U);
}

TEST(Columns, RefuseASampleThatIsTooShort) {
  EXPECT_THROW((void)table_of("int16 volts[3];", {{1, 0, 2, 0}}), DecodeError);
}

}  // namespace
}  // namespace crane::recording
