// Events of each vendor about its counterparts, and the sleep of wait().
#include "stage.hpp"

namespace crane::bus::testing {
namespace {

constexpr std::uint32_t kDomain = 43;

class Events : public ::testing::TestWithParam<VendorPair> {
 protected:
  Bus from{options(GetParam().writer, kDomain)};
  Bus to{options(GetParam().reader, kDomain)};
  Log writer_log, reader_log;
};

TEST_P(Events, BothSidesLearnThatTheyMatchedAndThatTheOtherLeft) {
  auto writer = std::make_optional(from.publisher(topics::state, {.on_event = writer_log.handler()}));
  {
    auto reader = to.subscriber(topics::state, {.on_event = reader_log.handler()});
    const auto came = writer_log.wait_for(EventKind::matched);
    ASSERT_TRUE(came);
    EXPECT_EQ(came->current, 1);
    EXPECT_EQ(came->topic, "crane/state");
    ASSERT_TRUE(reader_log.wait_for(EventKind::matched));
  }
  const auto left = writer_log.wait_for(EventKind::unmatched);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->current, 0);
  EXPECT_EQ(writer->matched(), 0);

  auto another = to.subscriber(topics::state, {.on_event = reader_log.handler()});
  ASSERT_TRUE(reader_log.wait_for(EventKind::matched, 2));
  writer.reset();
  EXPECT_TRUE(reader_log.wait_for(EventKind::unmatched));
}

TEST_P(Events, AMissedDeadlineIsReportedToBothSides) {
  const auto deadline = 50ms;
  auto writer = from.publisher(topics::state, {.deadline = deadline, .on_event = writer_log.handler()});
  auto reader = to.subscriber(topics::state, {.deadline = deadline, .on_event = reader_log.handler()});
  ASSERT_TRUE(matched(to, writer, reader));
  msg::State sample{};
  ASSERT_TRUE(writer.publish(sample));
  ASSERT_TRUE(next(to, reader));
  EXPECT_TRUE(reader_log.wait_for(EventKind::deadline_missed));
  EXPECT_TRUE(writer_log.wait_for(EventKind::deadline_missed));
}

TEST_P(Events, LivelinessIsLostInSilenceAndGainedByPublishing) {
  const auto lease = 150ms;
  auto writer = from.publisher(topics::state, {.liveliness_lease = lease, .on_event = writer_log.handler()});
  auto reader = to.subscriber(topics::state, {.liveliness_lease = lease, .on_event = reader_log.handler()});
  ASSERT_TRUE(matched(to, writer, reader));
  msg::State sample{};
  ASSERT_TRUE(writer.publish(sample));
  ASSERT_TRUE(reader_log.wait_for(EventKind::liveliness_gained));
  ASSERT_TRUE(reader_log.wait_for(EventKind::liveliness_lost));
  ASSERT_TRUE(writer_log.wait_for(EventKind::liveliness_lost));
  ASSERT_TRUE(writer.publish(sample));
  EXPECT_TRUE(reader_log.wait_for(EventKind::liveliness_gained, 2));
}

TEST_P(Events, AnIncompatibleReaderIsToldThePolicy) {
  auto writer = from.publisher(topics::state, {.on_event = writer_log.handler()});
  auto reader = to.subscriber(topics::state, {.deadline = 20ms, .on_event = reader_log.handler()});
  EXPECT_TRUE(reader_log.wait_for_refusal("deadline"));
  EXPECT_TRUE(writer_log.wait_for_refusal("deadline"));
  EXPECT_EQ(reader.matched(), 0);
  EXPECT_EQ(writer.matched(), 0);
}

TEST_P(Events, WaitReturnsOnDataAndOnTimeOut) {
  auto writer = from.publisher(topics::state);
  auto reader = to.subscriber(topics::state);
  ASSERT_TRUE(matched(to, writer, reader));
  EXPECT_FALSE(to.wait(5ms));
  msg::State sample{};
  ASSERT_TRUE(writer.publish(sample));
  EXPECT_TRUE(to.wait(kPatience));
  EXPECT_TRUE(reader.take());
  EXPECT_FALSE(to.wait(5ms));
}

TEST_P(Events, SamplesOfAClosedWriterAreStillDelivered) {
  auto reader = to.subscriber(topics::state, {.on_event = reader_log.handler()});
  {
    Bus closing{options(GetParam().writer, kDomain)};
    auto writer = closing.publisher(topics::state);
    ASSERT_TRUE(matched(to, writer, reader));
    for (std::uint64_t tick = 1; tick <= 3; ++tick) {
      msg::State sample{};
      sample.header.tick = tick;
      ASSERT_TRUE(writer.publish(sample));
    }
    ASSERT_TRUE(to.wait(kPatience));
  }
  ASSERT_TRUE(reader_log.wait_for(EventKind::unmatched));
  EXPECT_EQ(reader.matched(), 0);
  const auto sample = reader.take();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->header.tick, 1U);
}

TEST_P(Events, EndpointsOutliveTheirBus) {
  auto writing = std::make_unique<Bus>(options(GetParam().writer, kDomain));
  auto writer = writing->publisher(topics::state);
  auto reader = to.subscriber(topics::state);
  ASSERT_TRUE(matched(to, writer, reader));
  writing.reset();
  msg::State sample{};
  EXPECT_TRUE(writer.publish(sample));
  EXPECT_TRUE(next(to, reader));
}

TEST_P(Events, UnicastDiscoveryFindsTheOtherVendorWithoutMulticast) {
  const auto unicast = [](Vendor vendor) {
    auto with_peers = options(vendor, 44);
    with_peers.peers = {"127.0.0.1"};
    return with_peers;
  };
  Bus a{unicast(GetParam().writer)};
  Bus b{unicast(GetParam().reader)};
  auto writer = a.publisher(topics::state);
  auto reader = b.subscriber(topics::state);
  ASSERT_TRUE(matched(b, writer, reader));
  msg::State sample{};
  ASSERT_TRUE(writer.publish(sample));
  EXPECT_TRUE(next(b, reader));
}

INSTANTIATE_TEST_SUITE_P(Vendors, Events, kAllPairs, [](const auto& test) { return name_of(test.param); });

TEST(CycloneDomain, CannotBeOpenedTwiceWithDifferentPeers) {
  const Bus first{options(Vendor::cyclone, 45)};
  auto other = options(Vendor::cyclone, 45);
  other.peers = {"127.0.0.1"};
  EXPECT_THROW(Bus{other}, Error);
}

TEST(CycloneDomain, CanBeOpenedAgainAfterTheLastBusLeft) {
  for (int i = 0; i < 3; ++i) {
    Bus bus{options(Vendor::cyclone, 45)};
    auto writer = bus.publisher(topics::state);
    auto reader = bus.subscriber(topics::state);
    ASSERT_TRUE(matched(bus, writer, reader));
  }
}

}  // namespace
}  // namespace crane::bus::testing
