// The first difference of two samples.
#include "replay/difference.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "crane/bus/cdr.hpp"
#include "crane/bus/seal.hpp"

namespace crane::replay {
namespace {

template <class T>
std::vector<std::uint8_t> cdr_of(const topics::Topic<T>& topic, T sample) {
  bus::seal(topic.description, &sample, crane_SOURCE_FRICTION, 1);
  const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
  std::vector<std::uint8_t> cdr{0, 1, 0, 0};
  cdr.resize(cdr.size() + codec.max_encoded_bytes());
  cdr.resize(4 + codec.encode(&sample, std::span{cdr}.subspan(4)));
  return cdr;
}

std::optional<FieldDifference> of(const msg::Demand& recorded, const msg::Demand& replayed) {
  return first_difference(topics::demand.description, cdr_of(topics::demand, recorded),
                          cdr_of(topics::demand, replayed));
}

TEST(Difference, IsNothingForEqualSamplesAlsoWithNaN) {
  msg::Demand demand{};
  demand.total_v[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(of(demand, demand));
}

TEST(Difference, NamesTheFirstFieldAndElementWithAllDigits) {
  msg::Demand recorded{};
  recorded.friction_v[1] = 0.1;
  recorded.total_v[0] = 5;
  auto replayed = recorded;
  replayed.friction_v[1] = std::nextafter(0.1, 1);
  replayed.total_v[0] = 6;
  const auto found = of(recorded, replayed);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "friction_v[1]");
  EXPECT_EQ(found->recorded, "0.10000000000000001");
  EXPECT_EQ(found->replayed, "0.10000000000000002");
}

TEST(Difference, ComparesTheBitsOfNaNAndTheSignOfZero) {
  msg::Demand recorded{}, replayed{};
  recorded.control_v[0] = std::bit_cast<double>(0x7ff8000000000001ULL);
  replayed.control_v[0] = std::bit_cast<double>(0x7ff8000000000002ULL);
  auto found = of(recorded, replayed);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "control_v[0]");
  EXPECT_EQ(found->recorded, "nan (0x7ff8000000000001)");
  EXPECT_EQ(found->replayed, "nan (0x7ff8000000000002)");
  recorded.control_v[0] = 0.0;
  replayed.control_v[0] = -0.0;
  found = of(recorded, replayed);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->replayed, "-0");
}

TEST(Difference, NamesHeaderBooleanEnumerationAndText) {
  msg::Demand recorded{}, replayed{};
  replayed.header.tick = 3;
  EXPECT_EQ(of(recorded, replayed)->field, "header.tick");
  replayed = recorded;
  replayed.second_writer = true;
  EXPECT_EQ(of(recorded, replayed)->field, "second_writer");
  EXPECT_EQ(of(recorded, replayed)->replayed, "true");

  msg::SupervisorStatus run{}, hold{};
  run.state = crane_STATE_RUN;
  hold.state = crane_STATE_HOLD;
  const auto& topic = topics::supervisor;
  auto found = first_difference(topic.description, cdr_of(topic, run), cdr_of(topic, hold));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field + ' ' + found->recorded + ' ' + found->replayed, "state STATE_RUN STATE_HOLD");
  hold = run;
  std::snprintf(hold.move.client, sizeof hold.move.client, "other");
  found = first_difference(topic.description, cdr_of(topic, run), cdr_of(topic, hold));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "move.client");
  EXPECT_EQ(found->replayed, "other");
}

TEST(Difference, OfInvalidBytes) {
  const auto cdr = cdr_of(topics::demand, msg::Demand{});
  const auto found = first_difference(topics::demand.description, std::span{cdr}.first(20), cdr);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->recorded, "not a valid sample");
}

}  // namespace
}  // namespace crane::replay
