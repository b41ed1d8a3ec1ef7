// Attackers on other computers, and another user of this computer, who use as many connections, guesses of
// the token, viewers and unread answers as the server permits. An operator at another address is always
// served.
#include <sys/socket.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>

#include "../interop/two_hosts.hpp"
#include "../observation/samples.hpp"
#include "observation/observer.hpp"
#include "server_fixture.hpp"

namespace crane::dashboard {
namespace {

using namespace std::chrono_literals;
using hosts::OnHost;
using hosts::TwoHosts;
using Clock = std::chrono::steady_clock;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr const char* kOperator = "10.77.0.9";
/// Longest time until an operator is served (docs/dashboard.md): a client whose connection the kernel does
/// not queue tries again after 1 s and after 2 s more, and is then served within 1 s.
constexpr auto kServed = 4s;
/// Connections that one attacker keeps open.
constexpr std::size_t kHeld = 64;

std::string get_with(const std::string& token) {
  return "GET /api/about HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer " + token + "\r\n\r\n";
}

/// Creates the namespaces before the server, and the server in the near one.
struct NearHost {
  TwoHosts hosts;
  std::optional<OnHost> near{hosts.ok() ? std::optional<OnHost>{std::in_place, hosts.near()} : std::nullopt};
};

class RemoteOperator : private NearHost, public ServerTest {
 protected:
  RemoteOperator()
      : ServerTest{
            {.token = kToken, .host_names = {}, .other_origins = {}, .read_only = false}, {}, "0.0.0.0"} {}
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts.ok()) << "cannot make network namespaces with `ip netns`";
    hosts.add_far(kOperator);
  }
  ~RemoteOperator() override { end_attacks(); }

  tcp::socket connect_from(const std::string& address) {
    const OnHost far{hosts.far()};
    tcp::socket socket{context_, tcp::v4()};
    socket.set_option(asio::socket_base::reuse_address{true});
    socket.bind({asio::ip::make_address(address), 0});
    socket.connect({asio::ip::make_address(TwoHosts::kNear), server_.port()});
    const timeval patience{.tv_sec = 10, .tv_usec = 0};
    ::setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return socket;
  }
  /// @return status; 0: the server has ended the connection
  static unsigned ask(tcp::socket socket, http::verb verb, const std::string& target, const json& body,
                      const std::string& seat = "") {
    http::request<http::string_body> request{verb, target, 11, body.is_null() ? "" : body.dump()};
    request.set(http::field::host, "127.0.0.1");
    request.set(http::field::content_type, "application/json");
    request.set(http::field::authorization, std::string{"Bearer "} + kToken);
    request.set("X-Crane-Seat", seat);
    request.prepare_payload();
    boost::system::error_code error;
    http::write(socket, request, error);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response, error);
    return error ? 0 : response.result_int();
  }
  /// An operator looks, takes the controls, opens the stream of live data and stops the crane.
  void expect_served(const std::function<tcp::socket()>& connected) {
    Clock::duration longest{};
    for (int i = 0; i < 20; ++i) {
      const auto begin = Clock::now();
      EXPECT_EQ(ask(connected(), http::verb::get, "/api/about", nullptr), 200U) << i;
      EXPECT_EQ(ask(connected(), http::verb::get, "/", nullptr), 200U) << i;
      EXPECT_NE(ask(connected(), http::verb::post, "/api/operator/take", json::object()), 403U) << i;
      Viewer viewer{connected()};
      boost::system::error_code error;
      viewer.handshake("127.0.0.1", "/", error);
      EXPECT_FALSE(error) << i << ' ' << error.message();
      EXPECT_EQ(ask(connected(), http::verb::post, "/api/request", {{"kind", "estop"}}), 200U) << i;
      viewer.ping({}, error);
      EXPECT_FALSE(error) << i << " the stream of live data has ended";
      longest = std::max(longest, Clock::now() - begin);
    }
    std::cout << "served within " << std::chrono::duration_cast<std::chrono::milliseconds>(longest).count()
              << " ms\n";
    EXPECT_LT(longest, kServed);
    EXPECT_EQ(requests_, 20);
  }
  void expect_operator_served() {
    expect_served([this] { return connect_from(kOperator); });
  }

  /// Repeats `attack` with a new connection, and keeps the last connections open.
  void attack(std::function<tcp::socket()> connected, std::function<void(tcp::socket&)> attack) {
    attackers_.emplace_back([this, connected = std::move(connected), attack = std::move(attack)] {
      std::deque<tcp::socket> held;
      for (std::size_t round = 0; !stop_; ++round) try {
          auto socket = connected();
          attack(socket);
          held.push_back(std::move(socket));
          if (held.size() > kHeld) held.pop_front();
          if (round == kHeld) {
            ++prepared_;
            prepared_.notify_one();
          }
        } catch (const boost::system::system_error&) {  // refused or closed, as expected
        }
    });
  }
  void attack_from_far(std::size_t computers, const std::function<void(tcp::socket&)>& how) {
    for (std::size_t i = 0; i < computers; ++i) {
      const auto address = "10.77.0." + std::to_string(20 + i);
      hosts.add_far(address);
      attack([this, address] { return connect_from(address); }, how);
    }
    wait_until_prepared();
  }
  /// Waits until every attacker holds its connections.
  void wait_until_prepared() {
    for (auto prepared = prepared_.load(); prepared < attackers_.size(); prepared = prepared_)
      prepared_.wait(prepared);
  }
  void end_attacks() {
    stop_ = true;
    attackers_.clear();
  }
  static void guess(tcp::socket& socket) { asio::write(socket, asio::buffer(get_with("a wrong token"))); }
  static void watch(tcp::socket& socket) {
    asio::write(socket,
                asio::buffer(std::string{
                    "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"}));
    std::array<char, 64> answer{};
    (void)socket.read_some(asio::buffer(answer));
  }

  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> prepared_{0};
  std::vector<std::jthread> attackers_;
};

TEST_F(RemoteOperator, IsServedWhileOtherComputersGuessTheToken) {
  attack_from_far(4, guess);
  expect_operator_served();
}

TEST_F(RemoteOperator, IsServedWhileOtherComputersOpenConnections) {
  attack_from_far(4, [](tcp::socket&) {});
  expect_operator_served();
}

TEST_F(RemoteOperator, IsServedWhileOtherComputersOpenViewers) {
  attack_from_far(4, watch);
  expect_operator_served();
}

TEST_F(RemoteOperator, IsServedWhileOtherComputersDoNotReadTheirAnswers) {
  const auto sample = observation::sample_of(topics::state, msg::State{}, observation::log_now_ns());
  const auto count = observation::History::kLargestTopic_bytes / sample->cdr.size();
  for (std::size_t i = 0; i < count; i += 1000)
    server_.put(std::vector<observation::SamplePtr>(1000, sample));
  attack_from_far(4, [](tcp::socket& socket) {
    asio::write(
        socket,
        asio::buffer(std::string{"GET /api/history?topic=crane/state HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"}));
  });
  expect_operator_served();
}

TEST_F(RemoteOperator, IsServedWhileProgramsOfThisComputerGuessTheToken) {
  for (int i = 0; i < 4; ++i) attack([this] { return connect(); }, guess);
  wait_until_prepared();
  expect_operator_served();
}

TEST_F(RemoteOperator, AtTheRigIsServedWhileOtherComputersGuessTheToken) {
  attack_from_far(4, guess);
  expect_served([this] { return connect(); });
}

}  // namespace
}  // namespace crane::dashboard
