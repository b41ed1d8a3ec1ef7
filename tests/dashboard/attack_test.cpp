// Attacks on the dashboard: guessed tokens, two operators at once, pages of other origins, foreign names for
// this computer, floods, clients that do not read.
#include <gtest/gtest.h>

#include <fstream>
#include <future>

#include "../observation/samples.hpp"
#include "dashboard/connection_limits.hpp"
#include "observation/observer.hpp"
#include "server_fixture.hpp"

namespace crane::dashboard {
namespace {

using observation::sample_of;

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

class WithToken : public ServerTest {
 protected:
  WithToken() : ServerTest{{.token = kToken, .host_names = {}, .other_origins = {}, .read_only = false}} {}
  Response ask(const std::string& target, const json& body, const std::string& token) {
    http::request<http::string_body> request{http::verb::post, target, 11, body.dump()};
    request.set(http::field::content_type, "application/json");
    if (!token.empty()) request.set(http::field::authorization, "Bearer " + token);
    return exchange(request);
  }
};

TEST_F(WithToken, NobodyOperatesWithoutItEvenThroughAnUnidentifiedProxy) {
  EXPECT_EQ(ask("/api/operator/take", json::object(), "").result_int(), 403U);
  EXPECT_EQ(ask("/api/request", {{"kind", "arm"}}, "").result_int(), 403U);
  EXPECT_EQ(ask("/api/operator/take", json::object(), kToken).result_int(), 200U);
  EXPECT_EQ(requests_, 0);
}

TEST_F(WithToken, TheRigsOwnComputerMayStopWithoutIt) {
  EXPECT_EQ(ask("/api/request", {{"kind", "estop"}}, "").result_int(), 200U);
  http::request<http::string_body> request{http::verb::post, "/api/request", 11, R"({"kind":"estop"})"};
  request.set(http::field::content_type, "application/json");
  request.set("X-Forwarded-For", "192.0.2.1");
  EXPECT_EQ(exchange(request).result_int(), 403U);
  EXPECT_EQ(requests_, 1);
}

TEST_F(WithToken, TheRigsOwnComputerMayStopWithAWrongOneAndLearnsNothingAboutIt) {
  for (const auto* kind : {"stop", "estop"}) {
    const auto begin = Clock::now();
    EXPECT_EQ(ask("/api/request", {{"kind", kind}}, "guess").result_int(), 200U) << kind;
    EXPECT_LT(Clock::now() - begin, kGuessDelay) << kind;
  }
  EXPECT_EQ(requests_, 2);
  const std::string head = "POST /api/request HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer guess\r\n";
  const std::string json_type = "Content-Type: application/json\r\n";
  for (const auto& request :
       {head + json_type + "Content-Length: 14\r\n\r\n{\"kind\":\"arm\"}",
        head + json_type + "Content-Length: 15\r\n\r\n{\"kind\":\"stop\"",
        head + "Content-Type: text/plain\r\nContent-Length: 15\r\n\r\n{\"kind\":\"stop\"}",
        head + json_type + "X-Forwarded-For: 192.0.2.1\r\nContent-Length: 15\r\n\r\n{\"kind\":\"stop\"}"}) {
    const auto begin = Clock::now();
    EXPECT_NE(raw(request).find("403"), std::string::npos) << request;
    EXPECT_GE(Clock::now() - begin, kGuessDelay) << request;
  }
  EXPECT_EQ(requests_, 2);
}

TEST_F(WithToken, AWrongTokenIsAnsweredLateAndDelaysNoOtherRequest) {
  const auto begin = Clock::now();
  std::vector<std::future<std::pair<unsigned, Clock::duration>>> guesses;
  for (std::size_t i = 0; i + 1 < kMostGuesses; ++i)
    guesses.push_back(std::async(std::launch::async, [&, i] {
      http::request<http::string_body> request{http::verb::get, "/api/about", 11};
      request.set(http::field::authorization,
                  "Bearer " + std::string(31, 'a') + static_cast<char>('A' + static_cast<int>(i)));
      const auto status = exchange(request).result_int();
      return std::pair{status, Clock::now() - begin};
    }));
  EXPECT_EQ(ask("/api/operator/take", json::object(), kToken).result_int(), 200U);
  EXPECT_LT(Clock::now() - begin, kGuessDelay);
  for (auto& guess : guesses) {
    const auto [status, delay] = guess.get();
    EXPECT_EQ(status, 403U);
    EXPECT_GE(delay, kGuessDelay);
  }
}

/// The limit of a body depends on the token. An answer before the delay would reveal that the guess is wrong.
TEST_F(WithToken, AWrongTokenWithALongBodyIsAnsweredEquallyLate) {
  for (const char* body : {"Content-Length: 100000\r\n\r\n", "Transfer-Encoding: chunked\r\n\r\nFFFFF\r\n"}) {
    const auto begin = Clock::now();
    const auto answer =
        raw(std::string{"POST /api/uploads/a.csv HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: "
                        "application/octet-stream\r\nAuthorization: Bearer guess\r\n"} +
            body + std::string(5000, 'x'));
    EXPECT_GE(Clock::now() - begin, kGuessDelay) << body;
    EXPECT_NE(answer.find("403"), std::string::npos) << answer.substr(0, 80);
  }
}

/// A client that disconnects after its guess does not guess more often.
TEST_F(WithToken, AfterEightWrongTokensEvenTheCorrectOneIsNotComparedForASecond) {
  const auto begin = Clock::now();
  std::vector<tcp::socket> guesses;
  for (std::size_t i = 0; i < kMostGuesses; ++i) {
    guesses.push_back(connect());
    asio::write(guesses.back(),
                asio::buffer(std::string{"GET /api/about HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: "
                                         "Bearer guess\r\n\r\n"}));
  }
  constexpr unsigned kWithoutControls = 409;  // the answer to a correct token
  Response answer;
  while ((answer = ask("/api/operator/renew", json::object(), kToken)).result_int() == kWithoutControls) {
  }
  guesses.clear();
  EXPECT_EQ(answer.result_int(), 403U);
  EXPECT_NE(answer.body().find("too many wrong tokens"), std::string::npos) << answer.body();
  EXPECT_EQ(get("/api/about").result_int(), 200U);
  EXPECT_EQ(ask("/api/request", {{"kind", "estop"}}, kToken).result_int(), 200U)
      << "a stop needs no token here";
  while (ask("/api/operator/renew", json::object(), kToken).result_int() == 403U) {
  }
  EXPECT_GE(Clock::now() - begin, kGuessDelay);
  EXPECT_LT(Clock::now() - begin, 2 * kGuessDelay);
}

TEST_F(ServerTest, GivesTheControlsToOneOfManySimultaneousOperators) {
  std::vector<std::future<unsigned>> operators;
  for (int i = 0; i < 16; ++i)
    operators.push_back(std::async(std::launch::async, [&, i] {
      return post("/api/operator/take", {{"name", std::to_string(i)}}).result_int();
    }));
  int taken = 0;
  for (auto& one : operators) taken += one.get() == 200U ? 1 : 0;
  EXPECT_EQ(taken, 1);
}

TEST_F(ServerTest, AnInvalidRequestIsAnsweredWithAReason) {
  for (const auto& body : {json::array(), json(nullptr), json{{"kind", 1e300}},
                           json{{"kind", "arm"}, {"tick", 1}}, json{{"kind", "move"}, {"trolley_m", "far"}},
                           json::parse(std::string(500, '[') + std::string(500, ']'))}) {
    const auto answer = post("/api/request", body);
    EXPECT_EQ(answer.result_int(), 400U);
    EXPECT_NE(answer.body().find("error"), std::string::npos);
  }
  EXPECT_EQ(requests_, 0);
}

TEST_F(ServerTest, AReleasedSeatDoesNotOperateAnyMore) {
  const auto take = [&] {
    return json::parse(post("/api/operator/take", {{"name", "Ada"}}).body())["seat"].get<std::string>();
  };
  const auto stale = take();
  post("/api/operator/release", json::object(), stale);
  const auto fresh = take();
  EXPECT_EQ(post("/api/request", {{"kind", "arm"}}, stale).result_int(), 409U);
  EXPECT_EQ(post("/api/operator/renew", json::object(), stale).result_int(), 409U);
  EXPECT_FALSE(
      json::parse(post("/api/operator/release", json::object(), stale).body())["released"].get<bool>());
  EXPECT_EQ(post("/api/operator/renew", json::object(), fresh).result_int(), 200U);
  EXPECT_EQ(requests_, 0);
}

TEST_F(ServerTest, APageOfAnotherOriginLoadsNothingButMayLinkToThePage) {
  http::request<http::string_body> request{http::verb::get, "/api/history?topic=crane/state", 11};
  request.set("Sec-Fetch-Dest", "image");
  for (const auto* site : {"cross-site", "same-site"}) {
    request.set("Sec-Fetch-Site", site);
    EXPECT_EQ(exchange(request).result_int(), 403U) << site;
  }
  request.target("/");
  request.set("Sec-Fetch-Dest", "iframe");
  EXPECT_EQ(exchange(request).result_int(), 403U);
  request.set("Sec-Fetch-Dest", "document");
  EXPECT_EQ(exchange(request).result_int(), 200U);
}

/// A proxy in front of the dashboard may check the other one of the two headers.
TEST_F(ServerTest, ARequestWithTwoHeadersOfOneNameIsRefused) {
  const std::string head =
      "POST /api/request HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n";
  const std::string body = "Content-Length: 15\r\nConnection: close\r\n\r\n{\"kind\":\"stop\"}";
  for (const auto* second : {"Host: evil.example\r\n", "Content-Type: text/plain\r\n",
                             "Origin: http://127.0.0.1\r\nOrigin: http://evil.example\r\n"})
    EXPECT_NE(raw(head + second + body).find(" 400 "), std::string::npos) << second;
  EXPECT_EQ(requests_, 0);
  EXPECT_NE(raw(head + body).find(" 200 "), std::string::npos) << "without a second header it is refused too";
  EXPECT_EQ(requests_, 1);
}

TEST_F(ServerTest, AForeignNameForThisComputerGetsNoWebSocket) {
  Viewer viewer{connect()};
  viewer.set_option(beast::websocket::stream_base::decorator([](beast::websocket::request_type& request) {
    request.set(http::field::origin, "http://evil.example:8765");
  }));
  EXPECT_THROW(viewer.handshake("evil.example:8765", "/"), boost::system::system_error);
}

/// A browser sends the true Host of this computer with the Origin of the foreign page.
TEST_F(ServerTest, APageOfAnotherOriginGetsNoWebSocket) {
  for (const auto* origin : {"http://evil.example", "null", "http://127.0.0.1:1"}) {
    Viewer viewer{connect()};
    viewer.set_option(beast::websocket::stream_base::decorator(
        [origin](beast::websocket::request_type& request) { request.set(http::field::origin, origin); }));
    EXPECT_THROW(viewer.handshake("127.0.0.1:8765", "/"), boost::system::system_error) << origin;
  }
}

TEST_F(ServerTest, ASeatOfAnotherOperatorIsNotGuessedByOneWhoHeldItBefore) {
  const auto first =
      json::parse(post("/api/operator/take", {{"name", "Ada"}}).body())["seat"].get<std::string>();
  post("/api/operator/release", json::object(), first);
  EXPECT_EQ(post("/api/operator/take", {{"name", "Bob"}}).result_int(), 200U);
  for (std::size_t i = 0; i <= first.size(); ++i)  // every beginning of the old key, and the whole of it
    EXPECT_EQ(post("/api/request", {{"kind", "arm"}}, first.substr(0, i)).result_int(), 409U) << i;
  EXPECT_EQ(requests_, 0);
}

long resident_kb() {
  std::ifstream file{"/proc/self/statm"};
  long all = 0, resident = 0;
  file >> all >> resident;
  return resident * (::sysconf(_SC_PAGESIZE) / 1024);
}

TEST_F(ServerTest, ClientsThatDoNotReadTheirAnswersUseBoundedMemory) {
  auto viewer = view(kViewerProtocol);
  subscribe(viewer, channel_of(Document::situation));
  const auto sample = sample_of(topics::state, msg::State{}, observation::log_now_ns());
  const auto count = observation::History::kLargestTopic_bytes / sample->cdr.size();
  for (std::size_t i = 0; i < count; i += 1000)
    server_.put(std::vector<observation::SamplePtr>(1000, sample));
  while (get("/api/history?topic=crane/state").body().size() <
         observation::History::kLargestTopic_bytes / 2) {
  }
  const auto before_kb = resident_kb();
  std::vector<tcp::socket> idle;
  std::string busy;
  for (std::size_t i = 0; i < kMostConnections - 8; ++i) {
    idle.push_back(connect());
    asio::write(
        idle.back(),
        asio::buffer(std::string{"GET /api/history?topic=crane/state HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"}));
    busy = raw("GET /api/about HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");  // the request has
                                                                                            // been answered
  }
  EXPECT_NE(busy.find("200 OK"), std::string::npos);
  EXPECT_LT(resident_kb() - before_kb, static_cast<long>(2 * kMostAnswers_bytes / 1024));
  std::string refused(12, '\0');
  asio::read(idle.back(), asio::buffer(refused));
  EXPECT_EQ(refused, "HTTP/1.1 503");
}

TEST_F(ServerTest, AViewerThatFloodsPingsIsDisconnected) {
  auto viewer = view(kViewerProtocol);
  boost::system::error_code error;
  for (int i = 0; i < 100'000 && !error; ++i) viewer.ping({}, error);
  EXPECT_TRUE(error);
  EXPECT_EQ(get("/api/about").result_int(), 200U);
}

TEST_F(ServerTest, ConnectionsThatRequestNothingDoNotKeepAnOperatorOut) {
  std::vector<tcp::socket> idle;
  for (std::size_t i = 0; i < 2 * kMostConnections; ++i) idle.push_back(connect());
  EXPECT_EQ(post("/api/request", {{"kind", "estop"}}).result_int(), 200U);
  EXPECT_EQ(requests_, 1);
}

TEST_F(ServerTest, ViewersDoNotKeepAnOperatorOut) {
  std::vector<Viewer> viewers;
  for (std::size_t i = 0; i < kMostViewers; ++i) viewers.push_back(view(kViewerProtocol));
  EXPECT_THROW((void)view(kViewerProtocol), boost::system::system_error);
  std::vector<tcp::socket> idle;
  for (std::size_t i = 0; i < kMostConnections; ++i) idle.push_back(connect());
  EXPECT_EQ(post("/api/request", {{"kind", "estop"}}).result_int(), 200U);
  boost::system::error_code error;
  viewers.front().ping({}, error);
  EXPECT_FALSE(error) << "no viewer is displaced";
}

}  // namespace
}  // namespace crane::dashboard
