#pragma once
/// One port for pages, /api, /metrics and the WebSockets of viewers. Asynchronous, in one thread. The number
/// of connections, and the memory and time of each, are bounded.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <memory>
#include <set>

#include "dashboard/api.hpp"
#include "dashboard/connection_limits.hpp"
#include "dashboard/inbox.hpp"
#include "dashboard/rate_limit.hpp"

namespace crane::dashboard {

class ViewerSession;

/// Bounds of the server; connection_limits.hpp states those of the connections.
inline constexpr std::uint32_t kLongestHeader_bytes = 8192;
inline constexpr std::uint64_t kLongestBody_bytes = 4096;
inline constexpr std::chrono::seconds kUploadPatience{120};  ///< longest time of an upload (16 MB)
/// Longest time of a request, and between two requests.
inline constexpr std::chrono::seconds kRequestPatience{10};
inline constexpr std::chrono::seconds kViewerPatience{20};  ///< a silent viewer is pinged, then disconnected
/// Period of the frames to the page and of the documents.
inline constexpr std::chrono::milliseconds kFramePeriod{16};

/// A connection that the server may end to admit a newer one.
class Displaceable {
 public:
  virtual ~Displaceable() = default;
  /// Ends the connection and releases its admission at once.
  virtual void displace() = 0;
};

class Server {
 public:
  /// @param send  see Api. @throws boost::system::system_error when the port cannot be opened
  Server(const std::string& address, unsigned short port, About about, AccessRules rules,
         std::function<void(const stack::OperatorRequest&, Answered)> send, const RunsOptions& runs = {});

  /// Serves until stop(). The calling thread then owns all members.
  void run();
  /// May be called by any thread.
  void stop();
  /// Passes samples to the server. May be called by any thread and never blocks: samples are dropped and
  /// counted when the server is too busy.
  void put(std::vector<observation::SamplePtr> samples);
  /// May be called by any thread.
  void set_other_versions(std::vector<bus::OtherVersion> others);
  /// Runs `work` in the thread of run(). May be called by any thread.
  void post(std::function<void()> work);
  [[nodiscard]] unsigned short port() const;

  // For the sessions.
  [[nodiscard]] Api& api() { return api_; }
  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const AccessRules& rules() const { return rules_; }
  void join(const std::shared_ptr<ViewerSession>& viewer) { viewers_.insert(viewer); }
  void leave(const std::shared_ptr<ViewerSession>& viewer);
  /// @return true when a connection of this client may become a viewer
  [[nodiscard]] bool admits_viewer(const Client& client);
  /// @return true when the server may build the longest answer for this client now. Call before building it.
  [[nodiscard]] bool permits_history(const Client& client, RateLimit::Time now) {
    return limits_->has_room(observation::History::kLargestTopic_bytes) && histories_.permits(client, now);
  }
  /// Adds a viewer to the connections that can be displaced.
  void add_viewer(std::weak_ptr<Displaceable> viewer, const Client& client) {
    displaceable_.push_back({std::move(viewer), client, Kind::viewer});
  }
  [[nodiscard]] RateLimit& guess_limit() { return guesses_; }
  [[nodiscard]] RateLimit& history_limit() { return histories_; }
  /// Permits one upload at a time. @return false while another upload is in progress
  [[nodiscard]] bool begin_upload() { return !std::exchange(uploads_, true); }
  void end_upload() { uploads_ = false; }
  void count_slow_client() { ++counts_.slow_clients; }
  void count_refused_request() { ++counts_.refused_requests; }
  [[nodiscard]] const std::string& session_id() const { return session_id_; }

 private:
  void accept();
  void welcome(boost::asio::ip::tcp::socket socket);
  /// Ends a connection (for Kind::viewer: a viewer) of the same side, so that `client` can be admitted.
  /// Candidates: the connections of clients with more connections than `client`, and the
  /// connections of `client` itself that are not viewers. Ends the oldest candidate of the client
  /// with the most connections; viewers are ended last. A program that occupies all connections
  /// thus excludes no other client.
  /// @return false when there is no candidate
  bool displace_for(const Client& client, Kind kind);
  void take_samples();
  void beat();
  [[nodiscard]] ServerCounts counts() const;

  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer timer_, retry_;
  AccessRules rules_;
  Model model_;
  Api api_;
  Inbox<std::vector<observation::SamplePtr>> inbox_{kMostBatches};
  static constexpr std::size_t kMostBatches = 1000;  ///< several seconds of bus traffic
  std::set<std::shared_ptr<ViewerSession>> viewers_;
  struct DisplaceableConnection {
    std::weak_ptr<Displaceable> session;
    Client client;
    Kind kind;
  };
  std::deque<DisplaceableConnection> displaceable_;  ///< oldest first
  RateLimit guesses_{kMostGuesses}, histories_{kMostHistory_bytes};
  std::shared_ptr<ConnectionLimits> limits_ = std::make_shared<ConnectionLimits>();
  ServerCounts counts_;
  bool uploads_ = false;
  std::string session_id_ = random_token();
  /// Largest number of logged failures, so that an attacker cannot fill a disk.
  static constexpr std::uint64_t kMostReportedFailures = 20;
  std::uint64_t failures_ = 0;
};

}  // namespace crane::dashboard
