// Floods of requests on their way to the supervisor, over the memory bus.
#include "dashboard/request_sender.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "crane/runtime/process.hpp"

namespace crane::dashboard {
namespace {

using namespace std::chrono_literals;

bus::Options on(const std::shared_ptr<bus::MemoryNetwork>& network, const char* name, crane_Source source) {
  bus::Options options;
  options.vendor = bus::Vendor::memory;
  options.network = network;
  options.participant = name;
  options.source = source;
  return options;
}

class RequestSenderTest : public testing::Test {
 protected:
  std::vector<msg::Request> take_all() {
    std::vector<msg::Request> all;
    while (const auto request = requests_.take()) all.push_back(*request);
    return all;
  }
  void answer(const msg::Request& request, bool accepted) {
    msg::Reply reply{};
    reply.request_id = request.id;
    std::copy(std::begin(request.client), std::end(request.client), std::begin(reply.client));
    reply.accepted = accepted;
    ASSERT_TRUE(replies_.publish(reply));
  }

  using OnRequest = std::function<void(const msg::Request&, bus::WriterId)>;
  /// Polls `sender` as if `duration` passed. @return the writer of each request that arrived
  std::vector<bus::WriterId> writers_for(std::chrono::nanoseconds duration, const OnRequest& on_request,
                                         RequestSender& sender) {
    std::vector<bus::WriterId> writers;
    bus::SampleInfo info;
    const auto begin_ns = runtime::monotonic_ns();
    for (auto passed = 0ns; passed <= duration; passed += 50ms) {
      sender.poll(begin_ns + passed.count());
      while (const auto request = requests_.take(&info)) {
        writers.push_back(info.writer);
        if (on_request) on_request(*request, info.writer);
      }
    }
    return writers;
  }
  std::vector<bus::WriterId> writers_for(std::chrono::nanoseconds duration,
                                         const OnRequest& on_request = {}) {
    return writers_for(duration, on_request, sender_);
  }

  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  bus::Bus supervisor_{on(network_, "supervisor", crane_SOURCE_SUPERVISOR)};
  bus::Subscriber<msg::Request> requests_ = supervisor_.subscriber(topics::request);
  bus::Publisher<msg::Reply> replies_ = supervisor_.publisher(topics::reply);
  bus::Bus bus_{on(network_, "dashboard", crane_SOURCE_OPERATOR)};
  RequestSender sender_{bus_};
};

TEST_F(RequestSenderTest, AThousandStopsAtOnceAreOneRequestAndAllAreAnswered) {
  int answered = 0;
  for (int i = 0; i < 1000; ++i)
    sender_.send({.kind = crane_REQUEST_ESTOP},
                 [&](const Reply& reply) { answered += reply.accepted ? 1 : 0; });
  const auto sent = take_all();
  ASSERT_EQ(sent.size(), 1U);
  answer(sent.front(), true);
  sender_.poll(runtime::monotonic_ns());
  EXPECT_EQ(answered, 1000);
}

TEST_F(RequestSenderTest, AStopIsSentWhileManyOtherRequestsWait) {
  int refused = 0;
  for (int i = 0; i < 1000; ++i)
    sender_.send({.kind = crane_REQUEST_RESET},
                 [&](const Reply& reply) { refused += reply.accepted ? 0 : 1; });
  EXPECT_EQ(take_all().size(), RequestSender::kMostWaiting);
  EXPECT_EQ(refused, 1000 - static_cast<int>(RequestSender::kMostWaiting));
  sender_.send({.kind = crane_REQUEST_ESTOP}, [](const Reply&) {});
  const auto sent = take_all();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent.front().kind, crane_REQUEST_ESTOP);
}

/// A forged packet can make the supervisor skip all samples of one writer.
TEST_F(RequestSenderTest, AStopWithoutAnswerIsRepeatedByTheFirstWriterAndByOthers) {
  sender_.send({.kind = crane_REQUEST_ESTOP}, [](const Reply&) {});
  const auto writers = writers_for(1'500ms);
  EXPECT_GE(std::set(writers.begin(), writers.end()).size(), 3U);
  EXPECT_GE(std::ranges::count(writers, writers.front()), 6);
}

TEST_F(RequestSenderTest, AnAnswerToAnotherWriterMakesItTheWriterOfTheNextRequest) {
  int answered = 0;
  sender_.send({.kind = crane_REQUEST_ESTOP},
               [&](const Reply& reply) { answered += reply.accepted ? 1 : 0; });
  const auto first = writers_for(0ms).front();
  std::optional<bus::WriterId> other;
  (void)writers_for(1'500ms, [&](const msg::Request& request, bus::WriterId writer) {
    if (writer == first || other) return;
    answer(request, true);
    other = writer;
  });
  ASSERT_EQ(answered, 1);
  sender_.send({.kind = crane_REQUEST_RESET}, [](const Reply&) {});
  EXPECT_EQ(writers_for(0ms), std::vector{other.value()});
}

/// With keys nobody can forge the packet, and every new writer begins an exchange of keys.
TEST_F(RequestSenderTest, WithKeysAllRepetitionsUseOneWriter) {
  auto options = on(network_, "dashboard", crane_SOURCE_OPERATOR);
  options.credentials.emplace();
  bus::Bus bus{options};
  RequestSender sender{bus};
  sender.send({.kind = crane_REQUEST_ESTOP}, [](const Reply&) {});
  const auto writers = writers_for(1'500ms, {}, sender);
  EXPECT_GE(writers.size(), 10U);
  EXPECT_EQ(std::set(writers.begin(), writers.end()).size(), 1U);
}

TEST_F(RequestSenderTest, AnAnsweredRequestFreesItsPlaceAtOnce) {
  int accepted = 0;
  for (int i = 0; i < 1000; ++i) {
    sender_.send({.kind = crane_REQUEST_RESET},
                 [&](const Reply& reply) { accepted += reply.accepted ? 1 : 0; });
    for (const auto& request : take_all()) answer(request, true);
    sender_.poll(runtime::monotonic_ns());
  }
  EXPECT_EQ(accepted, 1000);
}

}  // namespace
}  // namespace crane::dashboard
