#include "crane/bus/cdr.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "bad.h"
#include "crane/bus/bus.hpp"
#include "random_sample.hpp"

namespace crane::bus {
namespace {

using testing::encoded;
using testing::Random;
using testing::random_sample;

constexpr std::uint64_t kSeed = 7401;
constexpr int kSamples = 500;

std::vector<const dds_topic_descriptor_t*> types() {
  std::vector<const dds_topic_descriptor_t*> list{&bad_EveryKind_desc};
  for (const auto& topic : topics::kAll) list.push_back(topic.descriptor);
  return list;
}

TEST(CdrCodec, WritesTheBytesTheStandardPrescribes) {
  msg::Reply reply{};
  reply.header = {0x0102030405060708, -2, crane_SOURCE_OPERATOR, 9};
  reply.request_id = 3;
  std::strcpy(reply.client, "ab");
  reply.accepted = true;
  std::strcpy(reply.reason, "");
  reply.crc32c = 0x0A0B0C0D;
  const std::vector<std::uint8_t> expected{
      8,    7,    6,    5,    4,    3,    2,    1,     // tick
      0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF,  // sample_time_ns
      8,    0,    0,    0,    9,    0,    0,    0,     // source, epoch
      3,    0,    0,    0,    0,    0,    0,    0,     // request_id
      3,    0,    0,    0,    'a',  'b',  0,           // client: length with NUL, text
      1,                                               // accepted
      1,    0,    0,    0,    0,    0,    0,    0,     // reason: only its NUL, then padding
      0x0D, 0x0C, 0x0B, 0x0A};                         // crc32c
  EXPECT_EQ(encoded(CdrCodec::of(crane_Reply_desc), &reply), expected);
}

TEST(CdrCodec, DecodesEveryTypeUnchanged) {
  Random random{kSeed};
  for (const auto* type : types()) {
    const CdrCodec& codec = CdrCodec::of(*type);
    for (int i = 0; i < kSamples; ++i) {
      const auto sample = random_sample(codec, random);
      const auto bytes = encoded(codec, sample.data());
      ASSERT_FALSE(bytes.empty());
      std::vector<std::uint8_t> copy(codec.sample_bytes(), 0xA5);
      ASSERT_TRUE(codec.decode(bytes, false, copy.data())) << type->m_typename << ", seed " << kSeed;
      for (const auto& field : codec.fields()) {
        const auto* text = reinterpret_cast<const char*>(sample.data() + field.offset);
        const bool string = field.kind == CdrCodec::Field::Kind::string;
        const std::size_t n = string ? std::strlen(text) + 1 : field.size * std::size_t{field.count};
        ASSERT_EQ(std::memcmp(text, copy.data() + field.offset, n), 0)
            << type->m_typename << " at offset " << field.offset << ", seed " << kSeed;
      }
    }
  }
}

TEST(CdrCodec, ReadsTheOtherByteOrder) {
  const CdrCodec& codec = CdrCodec::of(crane_Contribution_desc);
  Random random{kSeed};
  const auto sample = random_sample(codec, random);
  auto bytes = encoded(codec, sample.data());
  std::size_t at = 0;
  for (const auto& field : codec.fields()) {
    at = (at + field.size - 1) / field.size * field.size;  // plain CDR aligns every value to its size
    for (std::uint32_t i = 0; i < field.count; ++i, at += field.size)
      std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                   bytes.begin() + static_cast<std::ptrdiff_t>(at + field.size));
  }
  ASSERT_EQ(at, bytes.size());
  std::vector<std::uint8_t> copy(codec.sample_bytes());
  ASSERT_TRUE(codec.decode(bytes, true, copy.data()));
  EXPECT_EQ(encoded(codec, copy.data()), encoded(codec, sample.data()));
}

TEST(CdrCodec, StaysWithinTheSizeItAnnounces) {
  for (const auto* type : types()) {
    const CdrCodec& codec = CdrCodec::of(*type);
    std::vector<std::uint8_t> longest(codec.sample_bytes(), 0);
    for (const auto& field : codec.fields())
      if (field.kind == CdrCodec::Field::Kind::string)
        std::memset(longest.data() + field.offset, 'x', field.count - 1);
    std::vector<std::uint8_t> out(codec.max_encoded_bytes());
    EXPECT_GT(codec.encode(longest.data(), out), 0U) << type->m_typename;
  }
}

TEST(CdrCodec, EncodesNothingWhenTheBufferIsTooSmall) {
  Random random{kSeed};
  for (const auto* type : types()) {
    const CdrCodec& codec = CdrCodec::of(*type);
    const auto sample = random_sample(codec, random);
    const std::size_t needed = encoded(codec, sample.data()).size();
    for (std::size_t room = 0; room < needed; ++room) {
      std::vector<std::uint8_t> out(room);
      ASSERT_EQ(codec.encode(sample.data(), out), 0U) << type->m_typename << " into " << room;
    }
  }
}

TEST(CdrCodec, RefusesAStringWithoutTerminator) {
  msg::Event event{};
  std::memset(event.code, 'x', sizeof event.code);
  EXPECT_TRUE(encoded(CdrCodec::of(crane_Event_desc), &event).empty());
}

TEST(CdrCodec, RefusesBooleansAndEnumsOutOfRange) {
  const CdrCodec& codec = CdrCodec::of(crane_NodeStatus_desc);
  msg::NodeStatus status{};
  auto bytes = encoded(codec, &status);
  ASSERT_TRUE(codec.decode(bytes, false, &status));
  bytes[16] = 12;  // header.source, whose largest value is 11
  EXPECT_FALSE(codec.decode(bytes, false, &status));

  msg::Command command{};
  const CdrCodec& command_codec = CdrCodec::of(crane_Command_desc);
  bytes = encoded(command_codec, &command);
  ASSERT_TRUE(command_codec.decode(bytes, false, &command));
  bytes[24 + 24] = 2;  // brake_release[0], after the header and three volts
  EXPECT_FALSE(command_codec.decode(bytes, false, &command));
}

TEST(CdrCodec, WritesTheKeyBigEndian) {
  const CdrCodec& codec = CdrCodec::of(crane_NodeStatus_desc);
  msg::NodeStatus status{};
  status.node = 0x01020304;
  std::array<std::uint8_t, 16> key{};
  ASSERT_EQ(codec.encode_key(&status, key), 4U);
  EXPECT_EQ((std::vector<std::uint8_t>{key.begin(), key.begin() + 4}),
            (std::vector<std::uint8_t>{1, 2, 3, 4}));
  msg::NodeStatus back{};
  ASSERT_TRUE(codec.decode_key(key, true, &back));
  EXPECT_EQ(back.node, status.node);
}

TEST(CdrCodec, KnowsWhichTypesHaveAKey) {
  EXPECT_TRUE(CdrCodec::of(crane_NodeStatus_desc).has_key());
  EXPECT_FALSE(CdrCodec::of(crane_CraneState_desc).has_key());
}

TEST(CdrCodec, FindsRoomForHeaderAndCrcInEveryTopic) {
  for (const auto& topic : topics::kAll)
    EXPECT_TRUE(CdrCodec::of(*topic.descriptor).is_sealable()) << topic.name;
  EXPECT_FALSE(CdrCodec::of(bad_Unsealed_desc).is_sealable());
  EXPECT_FALSE(CdrCodec::of(crane_Header_desc).is_sealable());
}

}  // namespace
}  // namespace crane::bus
