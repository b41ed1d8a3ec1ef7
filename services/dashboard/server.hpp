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

namespace crane::dashboard {

class ViewerSession;

/// Bounds of the server; connection_limits.hpp states those of the connections.
inline constexpr std::uint32_t kLongestHeader_bytes = 8192;
inline constexpr std::uint64_t kLongestBody_bytes = 4096;
inline constexpr std::chrono::seconds kUploadPatience{120};  ///< for an upload of 16 MB
inline constexpr std::chrono::seconds kRequestPatience{
    10};  ///< for a whole request, and between two requests
/// Delay of the answer to a wrong token. It occupies its connection meanwhile: at most 64 guesses per second.
inline constexpr std::chrono::milliseconds kGuessDelay{1000};
inline constexpr std::chrono::seconds kViewerPatience{20};  ///< a silent viewer is pinged, then disconnected
/// Period of the frames to the page and of the documents.
inline constexpr std::chrono::milliseconds kFramePeriod{16};

/// A connection that the server may end to admit a newer one.
class Displaceable {
 public:
  virtual ~Displaceable() = default;
  /// Ends the connection and releases its admission at once. @return false when the connection must not be
  /// displaced, because its answer to a wrong token is delayed
  [[nodiscard]] virtual bool displace() = 0;
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
  [[nodiscard]] bool has_most_viewers() const { return viewers_.size() >= kMostViewers; }
  /// Permits one upload at a time. @return false while another upload is in progress
  [[nodiscard]] bool begin_upload() { return !std::exchange(uploads_, true); }
  void end_upload() { uploads_ = false; }
  void count_slow_client() { ++counts_.slow_clients; }
  void refuse() { ++counts_.refused_requests; }
  [[nodiscard]] const std::string& session_id() const { return session_id_; }

 private:
  void accept();
  void welcome(boost::asio::ip::tcp::socket socket);
  /// Closes the oldest connection that is not a viewer, to admit a client at `address`. A client on another
  /// computer displaces only connections of its own address. A program that occupies all connections
  /// therefore cannot keep out an operator. @return false when there is no such connection
  bool displace_oldest(const std::string& address, bool foreign);
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
  struct Displaced {
    std::weak_ptr<Displaceable> session;
    std::string address;
  };
  std::deque<Displaced> displaceable_;  ///< in the order of their begin
  std::shared_ptr<ConnectionLimits> limits_ = std::make_shared<ConnectionLimits>();
  ServerCounts counts_;
  bool uploads_ = false;
  std::string session_id_ = random_token();
  /// largest number of reported failures, so that an attacker cannot fill a disk
  static constexpr std::uint64_t kMostReportedFailures = 20;
  std::uint64_t failures_ = 0;
};

}  // namespace crane::dashboard
