#include <gtest/gtest.h>

#include <cstring>

#include "crane/bus/bus.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/bus/seal.hpp"
#include "crc32c.hpp"
#include "random_sample.hpp"

namespace crane::bus {
namespace {

using testing::encoded;
using testing::Random;
using testing::random_sample;

constexpr std::uint64_t kSealSeed = 90125;

std::vector<std::uint8_t> sealed_sample(const topics::Description& topic, Random& random) {
  auto sample = random_sample(CdrCodec::of(*topic.descriptor), random);
  seal(topic, sample.data(), crane_SOURCE_SUPERVISOR, 42);
  return sample;
}

TEST(Seal, WritesSourceEpochAndTheCrcOfAllBytesBeforeItOfTheTopicsNameAndOfTheVersion) {
  Random random{kSealSeed};
  for (const auto& topic : topics::kAll) {
    const auto sample = sealed_sample(topic, random);
    msg::Header header;
    std::memcpy(&header, sample.data(), sizeof header);
    EXPECT_EQ(header.source, crane_SOURCE_SUPERVISOR);
    EXPECT_EQ(header.epoch, 42U);
    auto bytes = encoded(CdrCodec::of(*topic.descriptor), sample.data());
    std::uint32_t carried = 0;
    std::memcpy(&carried, bytes.data() + bytes.size() - 4, 4);
    bytes.resize(bytes.size() - 4);
    bytes.insert(bytes.end(), topic.name.begin(), topic.name.end());
    for (int i = 0; i < 4; ++i)  // the version in little endian
      bytes.push_back(static_cast<std::uint8_t>(crane_MESSAGES_VERSION >> (8 * i)));
    EXPECT_EQ(carried, crc32c_portable(bytes)) << topic.name;
    EXPECT_TRUE(intact(topic, sample.data())) << topic.name;
  }
}

TEST(Seal, DoesNotDependOnThePadding) {
  msg::Command a;
  msg::Command b;
  std::memset(&a, 0x00, sizeof a);
  std::memset(&b, 0xFF, sizeof b);
  const auto fill = [](msg::Command& command) {
    command.header = {.tick = 7, .sample_time_ns = 8, .source = crane_SOURCE_NONE, .epoch = 0};
    for (int i = 0; i < 3; ++i) {
      command.drive_v[i] = 1.5 * i;
      command.brake_release[i] = i == 1;
      command.homing[i] = i == 2;
    }
    command.watchdog_permission = true;
  };
  fill(a);
  fill(b);
  seal(topics::command.description, &a, crane_SOURCE_SUPERVISOR, 1);
  seal(topics::command.description, &b, crane_SOURCE_SUPERVISOR, 1);
  EXPECT_EQ(a.crc32c, b.crc32c);
}

TEST(Intact,
     IsFalseForASampleOfZeros) {  // sample of the Fast DDS back end for a payload that it cannot decode
  for (const auto& topic : topics::kAll) {
    const std::vector<std::uint8_t> zeros(topic.descriptor->m_size, 0);
    EXPECT_FALSE(intact(topic, zeros.data())) << topic.name;
  }
}

TEST(Intact, IsFalseOnAnotherTopicOfTheSameType) {
  Random random{kSealSeed};
  const auto sample = sealed_sample(topics::tracking.description, random);
  EXPECT_TRUE(intact(topics::tracking.description, sample.data()));
  EXPECT_FALSE(intact(topics::anti_swing.description, sample.data()));
}

TEST(Intact, IsFalseAfterAnyFieldChanged) {
  Random random{kSealSeed};
  for (const auto& topic : topics::kAll) {
    const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
    const auto sample = sealed_sample(topic, random);
    for (const auto& field : codec.fields()) {
      auto changed = sample;
      changed[field.offset] = static_cast<std::uint8_t>(changed[field.offset] ^ 1U);
      EXPECT_FALSE(intact(topic, changed.data())) << topic.name << " at offset " << field.offset;
    }
  }
}

/// Decodes and checks bytes like every reader.
bool handed_out(const topics::Description& topic, std::span<const std::uint8_t> payload,
                std::vector<std::uint8_t>& sample) {
  return CdrCodec::of(*topic.descriptor).decode(payload, false, sample.data()) &&
         intact(topic, sample.data());
}

TEST(Intact, RefusesEveryTruncatedPayload) {
  Random random{kSealSeed};
  for (const auto& topic : topics::kAll) {
    const auto original = sealed_sample(topic, random);
    auto bytes = encoded(CdrCodec::of(*topic.descriptor), original.data());
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const std::vector<std::uint8_t> cut{bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)};
      std::vector<std::uint8_t> sample(original.size());
      ASSERT_FALSE(handed_out(topic, cut, sample))
          << topic.name << " cut to " << length << ", seed " << kSealSeed;
    }
  }
}

/// Flips, overwrites, inserts or removes one to eight bytes.
std::vector<std::uint8_t> mutated(std::vector<std::uint8_t> bytes, Random& random) {
  const std::size_t changes = 1 + random() % 8;
  for (std::size_t i = 0; i < changes && !bytes.empty(); ++i) {
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size());
    switch (random() % 5) {
      case 0:
        *at = static_cast<std::uint8_t>(*at ^ (1U << random() % 8));
        break;
      case 1:
        *at = static_cast<std::uint8_t>(random());
        break;
      case 2:
        *at = random() % 2 == 0 ? 0x00 : 0xFF;
        break;
      case 3:
        bytes.insert(at, static_cast<std::uint8_t>(random()));
        break;
      default:
        bytes.erase(at, at + std::min<std::ptrdiff_t>(bytes.end() - at, 4));
        break;
    }
  }
  return bytes;
}

TEST(Intact, RefusesEveryMutatedPayload) {
  constexpr int kMutationsPerTopic = 20'000;
  Random random{kSealSeed};
  for (const auto& topic : topics::kAll) {
    const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
    for (int i = 0; i < kMutationsPerTopic; ++i) {
      const auto original = sealed_sample(topic, random);
      const auto bytes = encoded(codec, original.data());
      const auto payload = mutated(bytes, random);
      std::vector<std::uint8_t> sample(original.size());
      // Padding between fields, and up to 3 bytes after the last field, have no content: such a payload is
      // still intact.
      if (handed_out(topic, payload, sample)) {
        ASSERT_EQ(encoded(codec, sample.data()), bytes)
            << topic.name << ", mutation " << i << ", seed " << kSealSeed;
      }
    }
  }
}

TEST(Intact, RefusesRandomBytes) {
  Random random{kSealSeed};
  for (const auto& topic : topics::kAll) {
    for (int i = 0; i < 5'000; ++i) {
      std::vector<std::uint8_t> payload(random() % 1024);
      for (auto& byte : payload) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : 0);
      std::vector<std::uint8_t> sample(topic.descriptor->m_size);
      ASSERT_FALSE(handed_out(topic, payload, sample)) << topic.name << ", seed " << kSealSeed;
    }
  }
}

}  // namespace
}  // namespace crane::bus
