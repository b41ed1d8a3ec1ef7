#pragma once
/// One WebSocket: a viewer with foxglove.websocket.v1, or the page, which receives the same messages in
/// batches.
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <map>

#include "dashboard/server.hpp"

namespace crane::dashboard {

class ViewerSession final : public Displaceable, public std::enable_shared_from_this<ViewerSession> {
 public:
  using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;
  ViewerSession(boost::asio::ip::tcp::socket socket, Server& server, std::unique_ptr<Admission> admission);

  void accept(UpgradeRequest request);
  void displace() override;
  void send_sample(const observation::SamplePtr& sample);
  void send_document(Document document, const Bytes& text, std::int64_t time_ns);
  void send_time(std::int64_t time_ns);
  /// Sends waiting messages: to the page once per frame period of the server, to a viewer at once.
  void flush();
  [[nodiscard]] std::uint64_t dropped() const { return queue_.dropped(); }

 private:
  void accepted();
  [[nodiscard]] bool spend_allowance();
  void read();
  void was_read(std::size_t bytes);
  void obey(const ClientMessage& message);
  void subscribe(const Subscribe& subscribe);
  void send_text(std::string text);
  void put(Outgoing message);
  void write();
  void end();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  Server& server_;
  std::unique_ptr<Admission> admission_;
  UpgradeRequest request_;
  bool batches_ = false;  ///< kPageProtocol
  bool open_ = false, writing_ = false;
  boost::beast::flat_buffer buffer_{kLongestMessage_bytes + 1};
  SendQueue queue_;
  Outgoing sending_;
  std::string batch_;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  ///< channel -> subscription id of the client
  std::int64_t allowance_from_ns_ = 0;
  int messages_ = 0;  ///< messages and pings of the client since allowance_from_ns_
};

void start_viewer_session(boost::asio::ip::tcp::socket socket, ViewerSession::UpgradeRequest request,
                          Server& server, std::unique_ptr<Admission> admission);

}  // namespace crane::dashboard
