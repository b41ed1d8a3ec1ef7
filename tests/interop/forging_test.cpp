// Forged payloads reach no application of either vendor and do not stop correct samples.
#include <cstring>

#include "../bus/random_sample.hpp"
#include "crane/bus/seal.hpp"
#include "forging_writer.hpp"
#include "stage.hpp"

namespace crane::bus::testing {
namespace {

constexpr std::uint32_t kDomain = 46;
constexpr std::uint64_t kSeed = 5150;

class Forging : public ::testing::TestWithParam<Vendor> {};

std::vector<std::uint8_t> payload_of(const topics::Description& topic, Random& random) {
  const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
  auto sample = random_sample(codec, random);
  codec.make_texts_printable(sample.data());  // readers change other texts
  seal(topic, sample.data(), crane_SOURCE_PLANT, 1);
  auto payload = encoded(codec, sample.data());
  payload.insert(payload.begin(), {0, 1, 0, 0});
  return payload;
}

/// A changed payload: cut, with flipped bits, longer, or random.
std::vector<std::uint8_t> forged(std::vector<std::uint8_t> payload, Random& random) {
  switch (random() % 5) {
    case 0:
      payload.resize(4 + random() % (payload.size() - 8));
      break;
    case 1:
      payload.back() = static_cast<std::uint8_t>(payload.back() ^ (1U << random() % 8));
      break;
    case 2:
      payload[4] = static_cast<std::uint8_t>(payload[4] ^ 0x80U);
      break;
    case 3:  // Cyclone DDS ignores bytes after the last field; therefore this case also changes the sample
      payload[5] = static_cast<std::uint8_t>(payload[5] ^ 1U);
      payload.resize(payload.size() + 4 + random() % 1500, 0x41);
      break;
    default:
      for (std::size_t i = 4; i < payload.size(); ++i) payload[i] = static_cast<std::uint8_t>(random());
      break;
  }
  return payload;
}

template <class T>
void expect_only_honest_samples(const topics::Topic<T>& topic, Vendor vendor) {
  const CdrCodec& codec = CdrCodec::of(*topic.description.descriptor);
  const auto meeting = options(vendor, kDomain);
  Bus bus{meeting};
  auto reader = bus.subscriber(topic);
  ForgingWriter forger{kDomain, meeting.crane, topic.description};
  ASSERT_TRUE(matched(bus, forger, reader));
  Random random{kSeed};
  for (int round = 0; round < 20; ++round) {
    const auto honest = payload_of(topic.description, random);
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(forger.send(forged(honest, random)));
    ASSERT_TRUE(forger.send(honest));
    const auto taken = next(bus, reader);
    ASSERT_TRUE(taken) << topic.description.name << ", round " << round << ", seed " << kSeed;
    auto bytes = encoded(codec, &*taken);
    bytes.insert(bytes.begin(), {0, 1, 0, 0});
    ASSERT_EQ(bytes, honest) << topic.description.name << ", round " << round << ", seed " << kSeed;
    ASSERT_FALSE(reader.take());
  }
  EXPECT_EQ(reader.counts().taken, 20U);
  EXPECT_GT(reader.counts().rejected, 0U);  // samples that the vendor refuses are not counted
}

TEST_P(Forging, OfStatesIsRejected) { expect_only_honest_samples(topics::state, GetParam()); }
TEST_P(Forging, OfCommandsIsRejected) { expect_only_honest_samples(topics::command, GetParam()); }
TEST_P(Forging, OfRequestsIsRejected) { expect_only_honest_samples(topics::request, GetParam()); }
TEST_P(Forging, OfEventsIsRejected) { expect_only_honest_samples(topics::event, GetParam()); }

INSTANTIATE_TEST_SUITE_P(Readers, Forging, ::testing::Values(Vendor::cyclone, Vendor::fastdds),
                         [](const auto& test) { return std::string{to_string(test.param)}; });

}  // namespace
}  // namespace crane::bus::testing
