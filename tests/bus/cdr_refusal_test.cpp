#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bad.h"
#include "crane/bus/bus.hpp"
#include "crane/bus/cdr.hpp"

namespace crane::bus {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Refused {
  const dds_topic_descriptor_t* type;
  const char* where;
  const char* why;
};

std::ostream& operator<<(std::ostream& out, const Refused& refused) {
  return out << refused.type->m_typename;
}

class Refusal : public ::testing::TestWithParam<Refused> {};

TEST_P(Refusal, NamesTypeFieldAndConstruct) {
  const Refused& refused = GetParam();
  try {
    const CdrCodec codec{*refused.type};
    FAIL() << refused.type->m_typename << " was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(std::string{"type "} + refused.type->m_typename),
                                    HasSubstr(refused.where), HasSubstr(refused.why)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Constructs, Refusal,
    ::testing::Values(Refused{&bad_WithUnboundedString_desc, "field culprit:", "unbounded string"},
                      Refused{&bad_WithSequence_desc, "field culprit:", "sequence"},
                      Refused{&bad_WithBoundedSequence_desc, "field culprit:", "bounded sequence"},
                      Refused{&bad_WithUnion_desc, "field culprit:", "union"},
                      Refused{&bad_WithBitMask_desc, "field culprit:", "bit mask"},
                      Refused{&bad_WithSmallEnum_desc, "field culprit:", "@bit_bound"},
                      Refused{&bad_WithOptional_desc, "field culprit:", "@optional"},
                      Refused{&bad_WithExternal_desc, "field culprit:", "@external"},
                      Refused{&bad_StringKey_desc, "field culprit:", "@key"},
                      Refused{&bad_TwoKeys_desc, "field culprit:", "second @key"},
                      Refused{&bad_ArrayOfStrings_desc, "field culprit:", "array of unbounded string"},
                      Refused{&bad_ArrayOfUnions_desc, "field culprit:", "array of union"},
                      Refused{&bad_Nested_desc, "field inner.culprit:", "sequence"},
                      Refused{&bad_NestedArray_desc, "field inner.culprit:", "sequence"},
                      Refused{&bad_LooseMember_desc, "field culprit:", "not @final"},
                      Refused{&bad_Derived_desc, "bad::Derived", "inheritance"},
                      Refused{&bad_IsAppendable_desc, "bad::IsAppendable", "not @final"},
                      Refused{&bad_IsMutable_desc, "bad::IsMutable", "not @final"}),
    [](const auto& test) { return std::string{test.param.type->m_typename}.substr(5); });

TEST(Bus, RefusesATopicWithoutHeaderAndCrcByName) {
  Bus bus{{.vendor = Vendor::memory, .network = make_memory_network()}};
  const topics::Topic<bad_Unsealed> topic{
      {"crane/unsealed", "bad::Unsealed", &bad_Unsealed_desc, topics::Qos::loop, false, topics::kProcesses}};
  try {
    (void)bus.publisher(topic);
    FAIL() << "a topic without a CRC was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("crane/unsealed"), HasSubstr("bad::Unsealed"), HasSubstr("CRC")));
  }
  EXPECT_THROW((void)bus.subscriber(topic), Error);
  EXPECT_THROW((void)bus.cdr_subscriber(topic.description), Error);
}

}  // namespace
}  // namespace crane::bus
