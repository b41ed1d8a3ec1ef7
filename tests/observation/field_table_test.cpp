/// Fields by name: all topics of the program, and the rules for unknown names.
#include "observation/field_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "crane/topics.hpp"

namespace crane::observation {
namespace {

using testing::HasSubstr;

TEST(FieldTable, HasEveryTopicOfTheProgram) {
  const FieldTable table;
  ASSERT_EQ(table.topics().size(), topics::kAll.size());
  for (std::size_t i = 0; i < topics::kAll.size(); ++i) {
    EXPECT_EQ(table.topics()[i].name, topics::kAll[i].name);
    EXPECT_EQ(table.topics()[i].every_tick, topics::kAll[i].every_tick);
  }
}

TEST(FieldTable, FindsAFieldByTopicAndPath) {
  const FieldTable table;
  const auto field = table.find("reference.axis[1].position");
  ASSERT_TRUE(field);
  EXPECT_EQ(table.name_of(*field), "reference.axis[1].position");
  EXPECT_EQ(table.leaf_of(*field).unit, "rad");
  EXPECT_TRUE(table.find("crane/state.applied_v[2]"));
  for (const char* name :
       {"state", "state.", "state.axis", "reference.axis[1]", "nothing.header.tick", ".", ""})
    EXPECT_FALSE(table.find(name)) << name;
}

TEST(FieldTable, NamesTheMostSimilarFieldForAnUnknownName) {
  const FieldTable table;
  EXPECT_EQ(table.explain("state.swing_radial_ra"),
            "unknown field 'state.swing_radial_ra'; did you mean state.swing_radial_rad?");
  EXPECT_THAT(
      table.explain("stat.swing_radial_rad"),
      HasSubstr("did you mean the topic state?; a field is written TOPIC.FIELD, and the topics are state, "));
  EXPECT_THAT(table.explain("state.applied_v"),
              HasSubstr("is not one number; choose one of applied_v[0], applied_v[1], applied_v[2]"));
  EXPECT_THAT(table.explain("state"), HasSubstr("is not one number; choose one of header.tick"));
  EXPECT_THAT(table.explain("state.qqqqqqqqqqqqqqqqqqqqqqqq"),
              HasSubstr("the fields of crane/state are header.tick"));
  EXPECT_THAT(table.explain("node.name"), HasSubstr("is a text"));
}

TEST(FieldTable, GivesExpressionsQuantitiesConditionsAndEnumerators) {
  const FieldTable table;
  FieldSelection selection{table};
  const auto trigger =
      expression::condition("supervisor.state == STATE_RUN and state.limit_low[0] and node.step_max_us > 2ms",
                            selection.vocabulary());
  ASSERT_EQ(selection.columns().size(), 3U);
  auto memory = trigger.memory();
  EXPECT_EQ(trigger.evaluate(std::vector<double>{crane_STATE_RUN, 1, 2001}, memory), 1);
  EXPECT_EQ(trigger.evaluate(std::vector<double>{crane_STATE_HOLD, 1, 2001}, memory), 0);
  EXPECT_EQ(trigger.evaluate(std::vector<double>{crane_STATE_RUN, 1, 1999}, memory), 0);
  EXPECT_THAT([&] { (void)expression::condition("supervisor.state == CAUSE_NONE", selection.vocabulary()); },
              testing::ThrowsMessage<expression::Error>(
                  HasSubstr("a value of crane::SupervisorState and a value of crane::Cause")));
}

TEST(FieldSelection, HasOneColumnForEachField) {
  const FieldTable table;
  FieldSelection selection{table};
  EXPECT_EQ(selection.add("state.trolley_position_m"), 0U);
  EXPECT_EQ(selection.add("state.slew_angle_rad"), 1U);
  EXPECT_EQ(selection.add("crane/state.trolley_position_m"), 0U);
  EXPECT_THROW(selection.add("state.trolley"), std::invalid_argument);
  EXPECT_THROW(selection.add("event.what"), std::invalid_argument);
}

}  // namespace
}  // namespace crane::observation
