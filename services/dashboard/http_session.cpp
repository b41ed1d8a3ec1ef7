#include "dashboard/http_session.hpp"

#include <algorithm>
#include <array>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <nlohmann/json.hpp>

#include "dashboard/viewer_session.hpp"

namespace crane::dashboard {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using beast::error_code;

std::string text_of(beast::string_view view) { return {view.data(), view.size()}; }
std::string_view view_of(beast::string_view view) { return {view.data(), view.size()}; }

std::string_view bearer_of(std::string_view authorization) {
  constexpr std::string_view kBearer = "Bearer ";
  return authorization.starts_with(kBearer) ? authorization.substr(kBearer.size()) : std::string_view{};
}

/// The page loads data only from this server, cannot be embedded in another page, and contains no inline
/// scripts.
constexpr const char* kContentRules =
    "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A report contains inline scripts. The sandbox gives the report another origin, so that its scripts cannot
/// read from or send to the dashboard.
constexpr const char* kReportRules =
    "sandbox allow-scripts allow-downloads; default-src 'none'; script-src 'unsafe-inline'; style-src "
    "'unsafe-inline'; img-src data: blob:; font-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors "
    "'none'";

constexpr const char* kTooManyAnswers = "too many answers wait for clients that do not read them";

class HttpSession final : public Displaceable, public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket socket, Server& server, std::unique_ptr<Admission> admission)
      : stream_{std::move(socket)}, server_{server}, admission_{std::move(admission)} {
    error_code ignored;
    loop_back_ = stream_.socket().remote_endpoint(ignored).address().is_loopback();
  }

  void displace() override {
    admission_.reset();
    guess_.cancel();
    error_code ignored;
    stream_.socket().close(ignored);
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(kLongestHeader_bytes);
    parser_->body_limit(kLongestUpload_bytes);
    stream_.expires_after(kRequestPatience);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](error_code error, std::size_t) {
                              self->judge_token();
                              error ? self->was_read(error) : self->read_body();
                            });
  }

 private:
  /// Compares the token of the request once and counts a wrong token immediately, so that an attacker who
  /// disconnects before the answer cannot guess more often.
  void judge_token() {
    token_ignored_ = token_wrong_ = false;
    if (!admission_ || !parser_->is_header_done() || visitor().token.empty()) return;
    const auto now = std::chrono::steady_clock::now();
    token_ignored_ = !server_.guess_limit().permits(admission_->client(), now);
    token_wrong_ = !token_ignored_ && sends_wrong_token(server_.rules(), visitor());
    if (token_wrong_) server_.guess_limit().count(admission_->client(), now);
  }

  void read_body() {
    const auto& request = parser_->get();
    const bool uploads = request.method() == http::verb::post &&
                         view_of(request.target()).starts_with(kUploadPath) &&
                         why_not_operate(server_.rules(), visitor()).empty();
    if (!uploads) {
      if (parser_->content_length().value_or(0) > kLongestBody_bytes)
        return was_read(http::make_error_code(http::error::body_limit));
      parser_->body_limit(kLongestBody_bytes);
    } else if (server_.begin_upload()) {
      upload_ = std::make_unique<Upload>(server_);
      stream_.expires_after(kUploadPatience);
    } else {
      return refuse(503, "another upload is under way: try again");
    }
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
      const auto ends_here = std::exchange(self->upload_, nullptr);
      self->was_read(error);
    });
  }

  void was_read(error_code error) {
    if (error == http::error::end_of_stream || error == beast::error::timeout) return close();
    // The delayed answer to a wrong token precedes any other error, because an immediate refusal would reveal
    // that the token is wrong. A stop that needs no token reveals nothing.
    if (token_wrong_ && (error || !server_.api().is_permitted_stop(api_request()))) return answer_guess();
    if (error == http::error::header_limit) return refuse(431, "the header is longer than 8192 bytes");
    if (error == http::error::body_limit)
      return refuse(413, "the body is longer than 4096 bytes, or an upload than 16 MB");
    if (error && error.category() == http::make_error_code(http::error::bad_method).category())
      return refuse(400, "this is no HTTP request");
    if (error) return close();
    if (repeats_a_header()) return refuse(400, "a header that the dashboard reads appears more than once");
    if (beast::websocket::is_upgrade(parser_->get())) return upgrade();
    answer();
  }

  /// A proxy may read another one of two equal headers than the dashboard.
  [[nodiscard]] bool repeats_a_header() const {
    const auto& request = parser_->get();
    return std::ranges::any_of(std::array{"Host", "Origin", "Sec-Fetch-Site", "Sec-Fetch-Dest",
                                          "Authorization", "Content-Type", "X-Crane-Seat", "X-Crane-Seen"},
                               [&](const char* name) { return request.count(name) > 1; });
  }

  [[nodiscard]] Visitor visitor() const {
    const auto& request = parser_->get();
    const bool passed_on = request.count("X-Forwarded-For") > 0 || request.count("Forwarded") > 0;
    return {.loop_back = loop_back_ && !passed_on,
            .host = view_of(request[http::field::host]),
            .origin = view_of(request[http::field::origin]),
            .fetched = view_of(request["Sec-Fetch-Site"]),
            .fetched_for = view_of(request["Sec-Fetch-Dest"]),
            .token =
                token_ignored_ ? std::string_view{} : bearer_of(view_of(request[http::field::authorization])),
            .token_ignored = token_ignored_};
  }

  void upgrade() {
    if (!may_look(server_.rules(), visitor())) {
      server_.count_refused_request();
      return refuse(403, "this dashboard answers its own pages only; --allow-origin permits others");
    }
    if (!admission_) return;  // displaced
    if (!server_.admits_viewer(admission_->client())) return refuse(503, "too many viewers: close one");
    admission_->become_viewer();
    stream_.expires_never();
    start_viewer_session(stream_.release_socket(), parser_->release(), server_, std::move(admission_));
  }

  [[nodiscard]] ApiRequest api_request() const {
    const auto& request = parser_->get();
    return {.method = text_of(request.method_string()),
            .target = text_of(request.target()),
            .content_type = text_of(request[http::field::content_type]),
            .body = request.body(),
            .seat_key = text_of(request["X-Crane-Seat"]),
            .status_id = text_of(request["X-Crane-Seen"]),
            .visitor = visitor()};
  }

  void answer() {
    const auto& request = parser_->get();
    if (!admission_) return;  // displaced
    const bool history = view_of(request.target()).starts_with("/api/history");
    const auto now = std::chrono::steady_clock::now();
    if (history && !server_.permits_history(admission_->client(), now)) return refuse(503, kTooManyAnswers);
    stream_.expires_never();  // the supervisor answers within 2 s; otherwise RequestSender answers
    server_.api().handle(
        api_request(), [self = shared_from_this(), head = request.method() == http::verb::head,
                        keep = request.keep_alive(), history, now](ApiAnswer answer) {
          if (history && self->admission_)
            self->server_.history_limit().count(self->admission_->client(), now, answer.body.size());
          if (answer.status == 403) self->server_.count_refused_request();
          self->send(std::move(answer), keep, head);
        });
  }

  /// Answers a wrong token after kGuessDelay, for every request, so that the attacker learns nothing before.
  void answer_guess() {
    stream_.expires_never();
    server_.count_refused_request();
    guess_.expires_after(kGuessDelay);
    guess_.async_wait(
        [self = shared_from_this()](error_code) { self->refuse(403, "the operator token is wrong"); });
  }

  void refuse(unsigned status, const char* what) {
    send({.status = status, .body = nlohmann::json{{"error", what}}.dump()}, false, false);
  }

  void send(ApiAnswer answer, bool keep, bool head_only) {
    if (!admission_) return;  // displaced
    if (!admission_->reserve(answer.body.size())) {
      answer = {.status = 503, .body = nlohmann::json{{"error", kTooManyAnswers}}.dump()};
      keep = false;
    }
    answer_ = std::move(answer);
    const auto bytes = answer_.file.empty() ? std::string_view{answer_.body} : answer_.file;
    response_.emplace();
    response_->result(answer_.status);
    response_->version(11);
    response_->keep_alive(keep);
    response_->set(http::field::content_type, answer_.media_type);
    response_->set(http::field::cache_control, answer_.file.empty() ? "no-store" : "no-cache");
    response_->set(http::field::x_frame_options, "DENY");
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("Referrer-Policy", "no-referrer");
    response_->set("Content-Security-Policy", answer_.report ? kReportRules : kContentRules);
    if (!head_only) response_->body() = {bytes.data(), bytes.size()};
    response_->content_length(bytes.size());
    stream_.expires_after(kRequestPatience * 3);  // longest time for a slow client to load the page
    http::async_write(stream_, *response_, [self = shared_from_this(), keep](error_code error, std::size_t) {
      if (error || !keep) return self->close();
      self->read();
    });
  }

  void close() {
    error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  }

  /// Holds the permission for the one upload at a time.
  struct Upload {
    explicit Upload(Server& of) : server{of} {}
    ~Upload() { server.end_upload(); }
    Upload(const Upload&) = delete;
    Upload& operator=(const Upload&) = delete;
    Server& server;
  };

  beast::tcp_stream stream_;
  Server& server_;
  std::unique_ptr<Admission> admission_;
  boost::asio::steady_timer guess_{stream_.get_executor()};
  bool token_wrong_ = false;    ///< the answer to this request is delayed
  bool token_ignored_ = false;  ///< the token of this request has not been compared
  bool loop_back_ = false;
  std::unique_ptr<Upload> upload_;
  beast::flat_buffer buffer_{kLongestHeader_bytes + kLongestBody_bytes};
  std::optional<http::request_parser<http::string_body>> parser_;
  ApiAnswer answer_;
  std::optional<http::response<http::span_body<const char>>> response_;
};

}  // namespace

std::weak_ptr<Displaceable> start_http_session(boost::asio::ip::tcp::socket socket, Server& server,
                                               std::unique_ptr<Admission> admission) {
  const auto session = std::make_shared<HttpSession>(std::move(socket), server, std::move(admission));
  session->read();
  return session;
}

}  // namespace crane::dashboard
