/// An HTTP client of the dashboard, and threads that attack the dashboard.
#pragma once
#include <sys/resource.h>

#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace crane::hostile {

using namespace std::chrono_literals;
namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

inline unsigned short free_port() {
  asio::io_context context;
  return tcp::acceptor{context, {asio::ip::make_address("127.0.0.1"), 0}}.local_endpoint().port();
}

class Client {
 public:
  explicit Client(unsigned short port) : port_{port} {}
  /// @return status; 0: the server closed the connection. Throws when the dashboard cannot be reached
  unsigned ask(http::request<http::string_body> request) {
    boost::beast::tcp_stream stream{context_};
    stream.connect(tcp::endpoint{asio::ip::make_address("127.0.0.1"), port_});
    if (request.count(http::field::host) == 0) request.set(http::field::host, "127.0.0.1");
    request.prepare_payload();
    error_code error;
    http::write(stream, request, error);
    boost::beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(16U << 20U);
    http::read(stream, buffer, parser, error);
    body_ = error ? "" : parser.get().body();
    return error ? 0 : parser.get().result_int();
  }
  unsigned get(const std::string& target) { return ask({http::verb::get, target, 11}); }
  unsigned post(const std::string& target, const std::string& body, const std::string& token,
                const std::string& seat = "") {
    http::request<http::string_body> request{http::verb::post, target, 11, body};
    request.set(http::field::content_type, "application/json");
    if (!token.empty()) request.set(http::field::authorization, "Bearer " + token);
    request.set("X-Crane-Seat", seat);
    if (!seat.empty()) request.set("X-Crane-Seen", seen());
    return ask(std::move(request));
  }
  /// Start-up number and tick of the newest status; empty: none has arrived.
  std::string seen() {
    if (get("/api/seen") != 200) return "";
    const auto digits = body_.find_first_of("0123456789");
    return digits == std::string::npos ? "" : body_.substr(digits, body_.rfind('"') - digits);
  }
  unsigned upload(const std::string& name, const std::string& bytes, const std::string& token) {
    http::request<http::string_body> request{http::verb::post, "/api/uploads/" + name, 11, bytes};
    request.set(http::field::content_type, "application/octet-stream");
    if (!token.empty()) request.set(http::field::authorization, "Bearer " + token);
    return ask(std::move(request));
  }
  [[nodiscard]] const std::string& body() const { return body_; }
  /// @return true when the dashboard answers within `patience`
  bool answers(std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) try {
        if (get("/api/about") == 200) return true;
      } catch (const boost::system::system_error&) {
        std::this_thread::sleep_for(20ms);
      }
    return false;
  }

 private:
  asio::io_context context_;
  unsigned short port_;
  std::string body_;
};

/// Attackers with the lowest priority, so that only the work that they cause for other processes has an
/// effect.
class Attackers {
 public:
  explicit Attackers(unsigned short port) : port_{port} {
    for (const auto* target :
         {"/api/history?topic=crane/state", "/metrics", "/vendor/three/three.core.min.js"})
      start([this, target] { Client{port_}.get(target); });
    for (const auto* body :
         {R"({"kind":"arm"})", R"({"kind":"move","trolley_m":1})", "[[[[[[[[[[[[[[[[", "{\"kind\":1e999}"})
      start([this, body] { Client{port_}.post("/api/request", body, ""); });
    start([this] { Client{port_}.get("/api/runs"); });
    start([this] { Client{port_}.post("/api/runs/review", R"({"run":"../../etc/passwd"})", ""); });
    start([this] { Client{port_}.upload("flood.csv", std::string(1U << 20U, 'x'), ""); });
    start([this] { Client{port_}.post("/api/operator/take", "{}", "guess"); });
    start([this] { trickle(); });
    start([this] { ping(); });
    start([this] { garbage(); });
  }
  ~Attackers() { stop_ = true; }
  [[nodiscard]] std::size_t attempts() const { return attempts_; }

 private:
  template <class Attack>
  void start(Attack attack) {
    threads_.emplace_back([this, attack] {
      ::setpriority(PRIO_PROCESS, 0, 19);
      while (!stop_) try {
          ++attempts_;
          attack();
        } catch (const boost::system::system_error&) {  // refused or closed, as expected
        }
    });
  }
  tcp::socket connected() {
    tcp::socket socket{context_};
    socket.connect({asio::ip::make_address("127.0.0.1"), port_});
    return socket;
  }
  /// Sends ten requests whose headers never end.
  void trickle() {
    constexpr auto kPause = 100ms;  // between two bytes of a header
    std::vector<tcp::socket> slow;
    for (int i = 0; i < 10; ++i) slow.push_back(connected());
    for (int i = 0; i < 20 && !stop_; ++i) {
      for (auto& socket : slow) asio::write(socket, asio::buffer("GET / HTTP/1.1\r\nX: ", i == 0 ? 19 : 1));
      std::this_thread::sleep_for(kPause);
    }
  }
  void ping() {
    websocket::stream<tcp::socket> viewer{connected()};
    viewer.handshake("127.0.0.1", "/");
    while (!stop_) viewer.ping({});
  }
  /// Sends a text frame that only empty frames continue, then the header of a frame of 2^63 bytes.
  void garbage() {
    websocket::stream<tcp::socket> viewer{connected()};
    viewer.handshake("127.0.0.1", "/");
    asio::write(viewer.next_layer(), asio::buffer(std::string("\x01\x80\0\0\0\0", 6)));
    for (int i = 0; i < 100'000 && !stop_; ++i)
      asio::write(viewer.next_layer(), asio::buffer(std::string("\x00\x80\0\0\0\0", 6)));
    asio::write(viewer.next_layer(),
                asio::buffer(std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff", 10)));
  }

  asio::io_context context_;
  unsigned short port_;
  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> attempts_{0};
  std::vector<std::jthread> threads_;
};

}  // namespace crane::hostile
