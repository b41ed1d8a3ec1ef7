// The server on a real socket of the loop-back, without a bus: answers to good, bad, slow and many clients.
#include <gtest/gtest.h>

#include <random>

#include "../observation/samples.hpp"
#include "crane/bus/path_stamps.hpp"
#include "server_fixture.hpp"

namespace crane::dashboard {
namespace {

using observation::kSecond_ns;
using observation::sample_of;

TEST_F(ServerTest, ServesThePageWithItsRules) {
  const auto page = get("/");
  EXPECT_EQ(page.result_int(), 200U);
  EXPECT_EQ(page[http::field::content_type], "text/html");
  EXPECT_EQ(page["X-Frame-Options"], "DENY");
  for (const char* rule : {"default-src 'none'", "script-src 'self';"})
    EXPECT_NE(page["Content-Security-Policy"].find(rule), beast::string_view::npos) << rule;
  EXPECT_GT(get("/vendor/three/three.core.min.js").body().size(), 300'000U);
}

TEST_F(ServerTest, NoPathLeadsOutOfThePage) {
  for (const auto* path : {"/../../etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd", "/style.css/..",
                           "/./style.css", "/style.css%00", "/page/style.css", "/vendor", "/vendor/"})
    EXPECT_EQ(get(path).result_int(), 404U) << path;
}

TEST_F(ServerTest, APathOfRequestsAnswersAGetWithTheMethodThatItExpects) {
  for (const char* path : {"/api/request", "/api/operator/take"})
    EXPECT_EQ(get(path).result_int(), 405U) << path;
}

TEST_F(ServerTest, OneClientOperatesAndEveryClientMayStop) {
  hear_tick(7);
  EXPECT_EQ(post("/api/request", {{"kind", "reset"}}).result_int(), 409U);
  const auto seat =
      json::parse(post("/api/operator/take", {{"name", "Ada"}}).body())["seat"].get<std::string>();
  EXPECT_EQ(post("/api/operator/take", {{"name", "Bob"}}).result_int(), 409U);
  EXPECT_TRUE(json::parse(post("/api/request", {{"kind", "reset"}}, seat).body())["accepted"].get<bool>());
  EXPECT_EQ(json::parse(post("/api/request", {{"kind", "arm"}}, seat).body())["reason"], "not READY");
  EXPECT_EQ(post("/api/request", {{"kind", "reset"}}, "guessed").result_int(), 409U);
  EXPECT_TRUE(json::parse(post("/api/request", {{"kind", "estop"}}).body())["accepted"].get<bool>());
  EXPECT_EQ(requests_, 3);
  EXPECT_EQ(post("/api/operator/release", json::object(), seat).result_int(), 200U);
  EXPECT_EQ(post("/api/operator/take", {{"name", "Bob"}}).result_int(), 200U);
}

/// An interrupted connection holds a request back, and delivers it when it is restored.
TEST_F(ServerTest, ARequestThatNamesNoTickOfTheLast2sIsRefused) {
  const auto seat =
      json::parse(post("/api/operator/take", {{"name", "Ada"}}).body())["seat"].get<std::string>();
  const auto move = [&] {
    return json::parse(post("/api/request", {{"kind", "move"}, {"trolley_m", 1}}, seat).body());
  };
  hear_tick(7, 3 * kSecond_ns);
  const auto too_old = status_id_;
  hear_tick(500, kSecond_ns);
  const auto in_time = status_id_;
  hear_tick(600);
  status_id_ = "";
  EXPECT_NE(move()["reason"].get<std::string>().find("X-Crane-Seen"), std::string::npos);
  for (const auto& id :
       {too_old, std::string{"12345-600"}, in_time + "0", std::string{"-600"}, std::string{"tick"}}) {
    status_id_ = id;
    EXPECT_NE(move()["reason"].get<std::string>().find("no status of the last 2 s"), std::string::npos) << id;
    EXPECT_TRUE(json::parse(post("/api/request", {{"kind", "disarm"}}, seat).body())["accepted"].get<bool>());
  }
  requests_ = 0;
  status_id_ = in_time;
  EXPECT_TRUE(move()["accepted"].get<bool>());
  EXPECT_EQ(newest_status_.tick, 500U) << "the supervisor compares this tick with the last stop";
  EXPECT_EQ(requests_, 1);
}

TEST_F(ServerTest, AHoldIsComputedFromAFreshState) {
  const auto seat =
      json::parse(post("/api/operator/take", {{"name", "Ada"}}).body())["seat"].get<std::string>();
  const auto hold = [&](std::int64_t age_ns) {
    msg::State state{};
    server_.put({observation::sample_of(topics::state, state, runtime::monotonic_ns() - age_ns, 8)});
    hear_tick(8);
    return json::parse(post("/api/request", {{"kind", "hold"}}, seat).body());
  };
  EXPECT_NE(hold(kSecond_ns)["reason"].get<std::string>().find("0.25 s"), std::string::npos);
  EXPECT_EQ(requests_, 0);
  EXPECT_TRUE(hold(0)["accepted"].get<bool>());
  EXPECT_EQ(requests_, 1);
}

TEST_F(ServerTest, AForeignPageCannotOperate) {
  http::request<http::string_body> request{http::verb::post, "/api/request", 11, R"({"kind":"estop"})"};
  request.set(http::field::content_type, "application/json");
  request.set(http::field::origin, "http://evil.example");
  EXPECT_EQ(exchange(request).result_int(), 403U);
  request.erase(http::field::origin);
  request.set(http::field::content_type,
              "text/plain");  // a form can send this type without a preflight request
  EXPECT_EQ(exchange(request).result_int(), 415U);
  request.set(http::field::content_type, "application/json");
  request.set(http::field::host, "evil.example");
  EXPECT_EQ(exchange(request).result_int(), 403U);
  request.set(http::field::host, "127.0.0.1");
  // a proxy on this computer forwards a request of another computer
  request.set("X-Forwarded-For", "192.0.2.1");
  EXPECT_EQ(exchange(request).result_int(), 403U);
  EXPECT_EQ(requests_, 0);
  EXPECT_THROW((void)view(kViewerProtocol, "http://evil.example"), boost::system::system_error);
}

TEST_F(ServerTest, BoundsHeadersAndBodies) {
  http::request<http::string_body> request{http::verb::get, "/", 11};
  request.set("X-Long", std::string(kLongestHeader_bytes, 'a'));
  EXPECT_EQ(exchange(request).result_int(), 431U);
  EXPECT_EQ(post("/api/request", {{"kind", std::string(kLongestBody_bytes, 'a')}}).result_int(), 413U);
  EXPECT_EQ(get("/" + std::string(5000, 'a')).result_int(), 404U);
  EXPECT_EQ(get("/api/history?topic=crane/nothing").result_int(), 400U);
  EXPECT_EQ(get("/api/history?topic=crane/state&from=1e5").result_int(), 400U);
  EXPECT_EQ(get("/api/history?topic=crane/state&fault=99999999999999999999").result_int(), 400U);
}

TEST_F(ServerTest, StaysUpUnderMutatedHttpAndWebSocketBytes) {
  const std::string request =
      "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nContent-Length: 0\r\n\r\n";
  // A masked text frame, a ping, and a frame with a stated length of 2^63 bytes.
  const std::string frames = std::string("\x81\x82\1\2\3\4zx", 8) + std::string("\x89\x80\1\2\3\4", 6) +
                             std::string("\x82\xff\xff\xff\xff\xff\xff\xff\xff\xff", 10);
  std::mt19937 random{3};
  std::uniform_int_distribution<int> byte{0, 255};
  for (int i = 0; i < 400; ++i) {
    std::string bytes = i % 2 == 0 ? request : request + frames;
    std::uniform_int_distribution<std::size_t> where{i % 4 == 3 ? request.size() : 0, bytes.size() - 1};
    for (int n = 0; n <= i % 5; ++n) bytes[where(random)] = static_cast<char>(byte(random));
    (void)raw(bytes);
  }
  EXPECT_EQ(get("/api/about").result_int(), 200U);
  EXPECT_EQ(metric("crane_dashboard_viewers"), "0");
}

TEST_F(ServerTest, BoundsItsConnectionsAndFreesThem) {
  std::vector<tcp::socket> many;
  for (std::size_t i = 0; i < kMostConnections; ++i) many.push_back(connect());
  auto beyond = connect();
  char byte = 0;
  boost::system::error_code error;
  beyond.read_some(asio::buffer(&byte, 1), error);
  EXPECT_TRUE(error == asio::error::eof || error == asio::error::connection_reset) << error.message();
  for (auto& socket : many) {
    socket.shutdown(tcp::socket::shutdown_send);
    socket.read_some(asio::buffer(&byte, 1), error);  // the server ends the connection
    EXPECT_EQ(error, asio::error::eof) << error.message();
  }
  EXPECT_EQ(get("/api/about").result_int(), 200U);
}

TEST_F(ServerTest, AViewerGetsChannelsSamplesAndDocuments) {
  auto viewer = view(kViewerProtocol);
  EXPECT_EQ(json::parse(read(viewer))["op"], "serverInfo");
  EXPECT_EQ(json::parse(read(viewer))["channels"].size(), channels().size());
  subscribe(viewer, channel_of_topic(0));
  // the arrival of this document shows that both subscriptions are active
  subscribe(viewer, channel_of(Document::seat));
  std::string message;
  while (message.empty() || message[0] != 1) message = read(viewer);
  EXPECT_EQ(json::parse(message.substr(13))["operator"], nullptr);
  const auto sample = sample_of(topics::state, msg::State{}, kSecond_ns);
  server_.put({sample});
  message.clear();
  while (message.empty() || message[0] != 1) message = read(viewer);
  EXPECT_EQ(message.substr(13), std::string(sample->cdr.begin(), sample->cdr.end()));
}

TEST_F(ServerTest, ASlowViewerLosesSamplesKeepsEventsAndDelaysNoOtherViewer) {
  auto slow = view(kViewerProtocol), quick = view(kPageProtocol);
  subscribe(slow, channel_of_topic(0));
  const auto event = channel_of_topic(bus::index_of(topics::event.description.name));
  subscribe(slow, event);
  subscribe(quick, channel_of_topic(0));
  for (auto* client :
       {&slow, &quick}) {  // the arrival of a document shows that earlier subscriptions are active
    subscribe(*client, channel_of(Document::seat));
    for (std::string message; message.empty() || message[0] != 1;) message = read(*client);
  }
  const auto sample = sample_of(topics::state, msg::State{}, kSecond_ns);
  for (int i = 0; i < 300; ++i) {
    server_.put(std::vector<observation::SamplePtr>(100, sample));
    if (i % 20 == 0) (void)read(quick);
  }
  server_.put({sample_of(topics::event, msg::Event{}, kSecond_ns)});
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(get("/api/about").result_int(), 200U);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{2});
  EXPECT_NE(metric("crane_dashboard_dropped_messages_total"), "0");
  bool heard = false;
  for (int i = 0; i < 40'000 && !heard; ++i) {
    const auto message = read(slow);
    heard = message.size() > 5 && message[0] == 1 && static_cast<unsigned char>(message[1]) == event;
  }
  EXPECT_TRUE(heard);
}

TEST_F(ServerTest, ASubscriptionThatIsRepeatedSendsTheStoredDataOnce) {
  constexpr std::size_t kStored = 20, kEntries = 64;
  server_.put(
      std::vector<observation::SamplePtr>(kStored, sample_of(topics::event, msg::Event{}, kSecond_ns)));
  auto viewer = view(kViewerProtocol);
  const auto event = channel_of_topic(bus::index_of(topics::event.description.name));
  const auto entries = std::vector<json>(kEntries, json{{"id", event}, {"channelId", event}});
  viewer.write(asio::buffer(json{{"op", "subscribe"}, {"subscriptions", entries}}.dump()));
  subscribe(viewer, channel_of(Document::seat));
  std::size_t stored = 0;
  for (std::string message;
       message.size() < 2 || message[0] != 1 || message[1] == static_cast<char>(event);) {
    message = read(viewer);
    stored += message.size() > 1 && message[0] == 1 && message[1] == static_cast<char>(event);
  }
  EXPECT_EQ(stored, kStored);
}

TEST_F(ServerTest, AClientThatFloodsMessagesIsDisconnected) {
  auto viewer = view(kViewerProtocol);
  boost::system::error_code error;
  for (int i = 0; i < 10'000 && !error; ++i) viewer.write(asio::buffer(std::string_view{"{}"}), error);
  while (!error) {
    beast::flat_buffer buffer;
    viewer.read(buffer, error);
  }
  EXPECT_EQ(get("/api/about").result_int(), 200U);
}

}  // namespace
}  // namespace crane::dashboard
