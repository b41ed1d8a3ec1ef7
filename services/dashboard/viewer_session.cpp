#include "dashboard/viewer_session.hpp"

#include <array>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "crane/runtime/process.hpp"
#include "observation/observer.hpp"

namespace crane::dashboard {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using beast::error_code;

/// Largest number of messages of a client per second. A page sends about five messages when a view opens.
constexpr int kMostMessages_ps = 100;
/// Send buffer of the kernel for one client. A larger buffer would only delay the samples of a slow client.
constexpr int kSendBuffer_bytes = 256 << 10;

bool offers(std::string_view list, std::string_view protocol) {
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    auto name = list.substr(0, comma);
    while (name.starts_with(' ')) name.remove_prefix(1);
    while (name.ends_with(' ')) name.remove_suffix(1);
    if (name == protocol) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

Bytes bytes_of(std::string_view text) {
  return std::make_shared<const std::vector<std::uint8_t>>(text.begin(), text.end());
}

/// Events, replies and statuses of processes are rare and important: they are never dropped.
Keep keep_of(const topics::Description& topic) { return topic.every_tick ? Keep::may_drop : Keep::always; }

}  // namespace

ViewerSession::ViewerSession(boost::asio::ip::tcp::socket socket, Server& server,
                             std::unique_ptr<Admission> admission)
    : socket_{std::move(socket)}, server_{server}, admission_{std::move(admission)} {
  error_code ignored;
  auto& tcp = socket_.next_layer().socket();
  tcp.set_option(boost::asio::ip::tcp::no_delay{true}, ignored);
  tcp.set_option(boost::asio::socket_base::send_buffer_size{kSendBuffer_bytes}, ignored);
}

void ViewerSession::accept(UpgradeRequest request) {
  request_ = std::move(request);
  const auto field = request_[beast::http::field::sec_websocket_protocol];
  const std::string_view offered{field.data(), field.size()};
  batches_ = offers(offered, kPageProtocol);
  const auto chosen = batches_ ? kPageProtocol : kViewerProtocol;
  socket_.set_option(websocket::stream_base::timeout{
      .handshake_timeout = kRequestPatience, .idle_timeout = kViewerPatience, .keep_alive_pings = true});
  const bool agreed = batches_ || offers(offered, kViewerProtocol);
  socket_.set_option(websocket::stream_base::decorator([agreed, chosen](websocket::response_type& response) {
    if (agreed)
      response.set(beast::http::field::sec_websocket_protocol,
                   beast::string_view{chosen.data(), chosen.size()});
  }));
  socket_.read_message_max(kLongestMessage_bytes);
  socket_.control_callback([this](websocket::frame_type kind, beast::string_view) {
    if (kind == websocket::frame_type::ping && !spend_allowance()) end();
  });
  socket_.async_accept(request_, [self = shared_from_this()](error_code error) {
    if (!error && self->admission_) self->accepted();  // without admission: displaced
  });
}

void ViewerSession::displace() {
  admission_.reset();
  beast::get_lowest_layer(socket_).close();
  end();
}

void ViewerSession::accepted() {
  open_ = true;
  request_ = {};
  server_.join(shared_from_this());
  send_text(server_info("crane " + server_.model().about().crane, server_.session_id()));
  static const Bytes kChannels = bytes_of(advertise());  // 1 MB, the same for all viewers
  put({.channel = 0, .keep = Keep::always, .binary = false, .head = {}, .payload = kChannels});
  flush();
  read();
}

void ViewerSession::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t bytes) {
    if (error) return self->end();
    self->was_read(bytes);
  });
}

bool ViewerSession::spend_allowance() {
  const auto now_ns = runtime::monotonic_ns();
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  if (now_ns - allowance_from_ns_ > kSecond_ns) {
    allowance_from_ns_ = now_ns;
    messages_ = 0;
  }
  return ++messages_ <= kMostMessages_ps;
}

void ViewerSession::was_read(std::size_t bytes) {
  const auto data = buffer_.data();
  const std::string_view text{static_cast<const char*>(data.data()), std::min(bytes, data.size())};
  if (!spend_allowance()) return end();
  try {
    if (!socket_.got_text()) throw ProtocolError("the dashboard takes no binary messages");
    obey(parse_client_message(text));
  } catch (const ProtocolError& error) {
    send_text(status_message(error.what()));
  }
  buffer_.consume(buffer_.size());
  flush();
  if (open_) read();
}

void ViewerSession::obey(const ClientMessage& message) {
  if (const auto* wanted = std::get_if<Subscribe>(&message)) return subscribe(*wanted);
  if (const auto* unwanted = std::get_if<Unsubscribe>(&message)) {
    for (const auto id : unwanted->ids)
      std::erase_if(subscriptions_, [id](const auto& entry) { return entry.second == id; });
  } else if (const auto* request = std::get_if<GetParameters>(&message)) {
    const auto& about = server_.model().about();
    nlohmann::json values = nlohmann::json::array();
    const std::array<std::pair<const char*, nlohmann::json>, 3> all{
        {{"crane", about.crane}, {"domain", about.domain}, {"version", about.version}}};
    for (const auto& [name, value] : all)
      if (request->names.empty() || std::ranges::find(request->names, name) != request->names.end())
        values.push_back({{"name", name}, {"value", value}});
    nlohmann::json answer{{"op", "parameterValues"}, {"parameters", values}};
    if (!request->id.empty()) answer["id"] = request->id;
    send_text(answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }
}

void ViewerSession::subscribe(const Subscribe& wanted) {
  for (const auto& [id, channel] : wanted.entries) {
    if (!open_) return;
    const bool begins = !subscriptions_.contains(channel);
    subscriptions_[channel] = id;
    if (!begins) continue;
    // Sends earlier data once: the newest document, or the stored samples of a rarely written topic.
    if (channel > topics::kAll.size()) {
      const auto document = static_cast<Document>(channel - topics::kAll.size() - 1);
      if (const auto& text = server_.model().text(document); !text.empty())
        send_document(document, bytes_of(text), observation::log_now_ns());
      continue;
    }
    if (topics::kAll[channel - 1].every_tick) continue;
    for (const auto& sample :
         server_.model().history().between(channel - 1, 0, std::numeric_limits<std::int64_t>::max()))
      send_sample(sample);
  }
}

void ViewerSession::send_sample(const observation::SamplePtr& sample) {
  const auto channel = channel_of_topic(sample->topic);
  const auto found = subscriptions_.find(channel);
  if (found == subscriptions_.end()) return;
  put({.channel = channel,
       .keep = keep_of(topic_of(*sample)),
       .binary = true,
       .head = message_head(found->second, sample->log_time_ns),
       .payload = Bytes{sample, &sample->cdr}});
}

void ViewerSession::send_document(Document document, const Bytes& text, std::int64_t time_ns) {
  const auto channel = channel_of(document);
  const auto found = subscriptions_.find(channel);
  if (found == subscriptions_.end()) return;
  put({.channel = channel,
       .keep = Keep::newest,
       .binary = true,
       .head = message_head(found->second, time_ns),
       .payload = text});
}

void ViewerSession::send_time(std::int64_t time_ns) {
  put({.channel = 0, .keep = Keep::newest, .binary = true, .head = time_message(time_ns), .payload = {}});
}

void ViewerSession::send_text(std::string text) {
  put({.channel = 0, .keep = Keep::always, .binary = false, .head = std::move(text), .payload = {}});
}

void ViewerSession::put(Outgoing message) {
  if (!open_) return;
  if (!queue_.put(std::move(message))) {
    server_.count_slow_client();
    end();
  }
}

void ViewerSession::flush() {
  if (open_ && !writing_ && !queue_.empty()) write();
}

void ViewerSession::write() {
  writing_ = true;
  const auto written = [self = shared_from_this()](error_code error, std::size_t) {
    self->writing_ = false;
    if (error) return self->end();
    if (!self->batches_ || self->queue_.bytes() > SendQueue::kDropAbove_bytes / 4) self->flush();
  };
  if (batches_) {
    batch_ = batch_of(queue_);
    socket_.binary(true);
    socket_.async_write(boost::asio::buffer(batch_), written);
    return;
  }
  sending_ = queue_.take();
  socket_.binary(sending_.binary);
  const std::array<boost::asio::const_buffer, 2> parts{
      boost::asio::buffer(sending_.head),
      sending_.payload ? boost::asio::buffer(*sending_.payload) : boost::asio::const_buffer{}};
  socket_.async_write(parts, written);
}

/// Ends the connection without a closing handshake, which a client that does not read would not answer.
void ViewerSession::end() {
  if (!std::exchange(open_, false)) return;
  beast::get_lowest_layer(socket_).cancel();
  beast::get_lowest_layer(socket_).close();
  server_.leave(shared_from_this());
}

void start_viewer_session(boost::asio::ip::tcp::socket socket, ViewerSession::UpgradeRequest request,
                          Server& server, std::unique_ptr<Admission> admission) {
  const auto client = admission->client();
  const auto session = std::make_shared<ViewerSession>(std::move(socket), server, std::move(admission));
  session->accept(std::move(request));
  server.add_viewer(session, client);
}

}  // namespace crane::dashboard
