#include "dashboard/foxglove.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "crane/topics.hpp"

namespace crane::dashboard {
namespace {

TEST(Foxglove, SubscriptionsNameChannelsThatExist) {
  const auto message = parse_client_message(R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":1}]})");
  const auto& entries = std::get<Subscribe>(message).entries;
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].id, 9U);
  EXPECT_EQ(entries[0].channel, 1U);
  const std::string after_the_last = std::to_string(channels().size() + 1);
  for (const std::string& channel :
       {std::string{"0"}, after_the_last, std::string{"4294967295"}, std::string{"-1"}, std::string{"1.5"},
        std::string{"\"1\""}, std::string{"null"}})
    EXPECT_THROW((void)parse_client_message(R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":)" +
                                            channel + "}]}"),
                 ProtocolError)
        << channel;
}

TEST(Foxglove, AnInvalidMessageOfAClientIsRefusedWithAReason) {
  for (const auto* text :
       {"", "{", "[]", "null", "{}", R"({"op":7})", R"({"op":"launch"})", R"({"op":"subscribe"})",
        R"({"op":"subscribe","subscriptions":{}})", R"({"op":"subscribe","subscriptions":[1]})",
        R"({"op":"unsubscribe","subscriptionIds":["a"]})", R"({"op":"getParameters"})",
        R"({"op":"setParameters"})", "{\"op\":\"\xff\xfe\"}"})
    EXPECT_THROW((void)parse_client_message(text), ProtocolError) << text;
}

TEST(Foxglove, ADeepMessageDoesNotFillTheStack) {
  const std::string deep = R"({"op":"subscribe","subscriptions":)" + std::string(30'000, '[');
  EXPECT_THROW((void)parse_client_message(deep), ProtocolError);
  EXPECT_THROW((void)parse_client_message(std::string(kLongestMessage_bytes + 1, ' ')), ProtocolError);
}

TEST(Foxglove, AMillionMutatedBytesEitherParseOrAreRefused) {
  const std::string seed =
      R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":13}],"parameterNames":["crane"]})";
  std::mt19937 random{7};
  std::uniform_int_distribution<std::size_t> where{0, seed.size() - 1};
  std::uniform_int_distribution<int> what{0, 255};
  for (int i = 0; i < 10'000; ++i) {
    auto text = seed;
    for (int n = 0; n <= i % 4; ++n) text[where(random)] = static_cast<char>(what(random));
    try {
      (void)parse_client_message(text);
    } catch (const ProtocolError& error) {
      EXPECT_FALSE(status_message(error.what()).empty());
    }
  }
}

TEST(Foxglove, EveryTopicIsAChannelWithTheIdlAsItsSchema) {
  ASSERT_EQ(channels().size(), topics::kAll.size() + kDocuments);
  for (std::size_t i = 0; i < topics::kAll.size(); ++i) {
    EXPECT_EQ(channels()[i].id, i + 1);
    EXPECT_EQ(channels()[i].topic, "/" + std::string{topics::kAll[i].name});
    EXPECT_EQ(channels()[i].schema_encoding, "omgidl");
  }
  EXPECT_EQ(channel_of(Document::seat), channels().size());
  const auto advertised = nlohmann::json::parse(advertise());
  EXPECT_EQ(advertised["channels"].size(), channels().size());
}

TEST(Foxglove, AFrameOfThePageContainsManyMessagesInTheirOrder) {
  SendQueue queue;
  ASSERT_TRUE(
      queue.put({.channel = 0, .keep = Keep::always, .binary = false, .head = "text", .payload = {}}));
  ASSERT_TRUE(
      queue.put({.channel = 1,
                 .keep = Keep::may_drop,
                 .binary = true,
                 .head = message_head(3, 5),
                 .payload = std::make_shared<const std::vector<std::uint8_t>>(2, std::uint8_t{0xAB})}));
  const auto frame = batch_of(queue);
  const std::string expected = std::string("\1\4\0\0\0text", 9) + std::string("\2\17\0\0\0", 5) +
                               std::string("\1\3\0\0\0\5\0\0\0\0\0\0\0", 13) + "\xAB\xAB";
  EXPECT_EQ(frame, expected);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace crane::dashboard
