#pragma once
/// A server on a real socket of the loop-back, without a bus, and clients of it.
#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>
#include <thread>

#include "../observation/samples.hpp"
#include "crane/runtime/process.hpp"
#include "dashboard/server.hpp"

namespace crane::dashboard {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using nlohmann::json;

/// A dashboard whose supervisor accepts everything but "arm".
class ServerTest : public testing::Test {
 protected:
  explicit ServerTest(AccessRules rules = {}, const RunsOptions& runs = {}, const char* address = "127.0.0.1")
      : server_{address,
                0,
                {.version = "0", .crane = "test", .domain = 0, .rig = ""},
                std::move(rules),
                [this](const stack::OperatorRequest& wanted, const Answered& answered) {
                  ++requests_;
                  newest_status_ = wanted.newest_status;
                  answered({wanted.kind != crane_REQUEST_ARM,
                            wanted.kind == crane_REQUEST_ARM ? "not READY" : ""});
                },
                runs} {}
  ~ServerTest() override { server_.stop(); }

  tcp::socket connect() {
    tcp::socket socket{context_};
    socket.connect({asio::ip::make_address("127.0.0.1"), server_.port()});
    // With this timeout, a test fails instead of hanging when an answer does not arrive.
    const timeval patience{.tv_sec = 10, .tv_usec = 0};
    ::setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return socket;
  }

  using Response = http::response<http::string_body>;
  Response exchange(http::request<http::string_body> request) {
    auto socket = connect();
    if (request.count(http::field::host) == 0) request.set(http::field::host, "127.0.0.1:8765");
    request.prepare_payload();
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(8U << 20U);
    if (request.method() == http::verb::head) parser.skip(true);
    http::read(socket, buffer, parser);
    return parser.release();
  }
  Response get(const std::string& target) { return exchange({http::verb::get, target, 11}); }
  Response post(const std::string& target, const json& body, const std::string& seat = "") {
    http::request<http::string_body> request{http::verb::post, target, 11, body.dump()};
    request.set(http::field::content_type, "application/json");
    request.set("X-Crane-Seat", seat);
    if (!status_id_.empty()) request.set("X-Crane-Seen", status_id_);
    return exchange(request);
  }
  std::string metric(const std::string& name) {
    const auto text = get("/metrics").body();
    const auto at = text.find("\n" + name + " ");
    return at == std::string::npos
               ? ""
               : text.substr(at + name.size() + 2, text.find('\n', at + 1) - at - name.size() - 2);
  }

  /// Sends the bytes without change, and reads until the server ends the connection.
  std::string raw(const std::string& bytes) {
    auto socket = connect();
    boost::system::error_code error;
    asio::write(socket, asio::buffer(bytes), error);
    socket.shutdown(tcp::socket::shutdown_send, error);
    std::string answer;
    asio::read(socket, asio::dynamic_buffer(answer), error);
    return answer;
  }

  using Viewer = beast::websocket::stream<tcp::socket>;
  Viewer view(std::string_view protocol, const std::string& origin = "") {
    Viewer viewer{connect()};
    viewer.set_option(beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, beast::string_view{protocol.data(), protocol.size()});
      if (!origin.empty()) request.set(http::field::origin, origin);
    }));
    viewer.handshake("127.0.0.1:" + std::to_string(server_.port()), "/");
    return viewer;
  }
  static std::string read(Viewer& viewer) {
    beast::flat_buffer buffer;
    viewer.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  static void subscribe(Viewer& viewer, std::uint32_t channel) {
    viewer.text(true);
    viewer.write(asio::buffer(
        json{{"op", "subscribe"}, {"subscriptions", {{{"id", channel}, {"channelId", channel}}}}}.dump()));
  }

  /// The server receives the status of this tick; the clients name it.
  void hear_tick(std::uint64_t tick, std::int64_t age_ns = 0) {
    server_.put({observation::status_at(runtime::monotonic_ns() - age_ns, crane_STATE_LOCKED,
                                        crane_CAUSE_START, tick)});
    const auto seen = [&] { return json::parse(get("/api/seen").body())["seen"]; };
    const auto end = "-" + std::to_string(tick);
    while (!seen().is_string() || !seen().get<std::string>().ends_with(end)) std::this_thread::yield();
    status_id_ = seen().get<std::string>();
  }

  std::string status_id_;
  asio::io_context context_;
  std::atomic<int> requests_{0};
  msg::Header newest_status_{};  ///< of the last request
  Server server_;
  std::jthread thread_{[this] { server_.run(); }};
};

}  // namespace crane::dashboard
