#pragma once
/// One port for pages, /api, /metrics and the WebSockets of viewers. Asynchronous, in one thread; it holds a
/// bounded number of connections, each with bounded memory and time.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <set>

#include "dashboard/api.hpp"
#include "dashboard/connection_limits.hpp"
#include "dashboard/inbox.hpp"

namespace crane::dashboard {

class ViewerSession;

/// The bounds of the server, beside those of connection_limits.hpp.
inline constexpr std::uint32_t kLongestHeader_bytes = 8192;
inline constexpr std::uint64_t kLongestBody_bytes = 4096;
inline constexpr std::chrono::seconds kUploadPatience{120};  ///< for an upload of 16 MB
inline constexpr std::chrono::seconds kRequestPatience{10};  ///< for a whole request; also between two
/// A wrong token is answered so late, and holds its connection for as long: at most 64 guesses a second.
inline constexpr std::chrono::milliseconds kGuessDelay{1000};
inline constexpr std::chrono::seconds kViewerPatience{20};  ///< a silent viewer is pinged, then given up
/// Period of the frames that the page gets, and of the documents.
inline constexpr std::chrono::milliseconds kFramePeriod{33};

class Server {
 public:
  /// @param send  see Api. @throws boost::system::system_error when the port cannot be opened
  Server(const std::string& address, unsigned short port, About about, AccessRules rules,
         std::function<void(const stack::Wish&, Answered)> send, const RunsOptions& runs = {});

  /// Serves until stop(). Called by one thread, which then owns everything here.
  void run();
  /// May be called by any thread.
  void stop();
  /// Hands over samples. May be called by any thread, and never blocks it: when this server is too busy,
  /// samples are lost and counted.
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
  /// One upload at a time: the others are refused. @return false when one is under way
  [[nodiscard]] bool begin_upload() { return !std::exchange(uploads_, true); }
  void end_upload() { uploads_ = false; }
  void give_up() { ++counts_.given_up_clients; }
  void refuse() { ++counts_.refused_requests; }
  [[nodiscard]] const std::string& session_id() const { return session_id_; }

 private:
  void accept();
  void welcome(boost::asio::ip::tcp::socket socket);
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
  static constexpr std::size_t kMostBatches = 1000;  ///< some seconds of the bus
  std::set<std::shared_ptr<ViewerSession>> viewers_;
  std::shared_ptr<ConnectionLimits> limits_ = std::make_shared<ConnectionLimits>();
  ServerCounts counts_;
  bool uploads_ = false;
  std::string session_id_ = random_token();
  static constexpr std::uint64_t kMostFailuresTold = 20;  ///< a stranger does not fill a disk with messages
  std::uint64_t failures_ = 0;
};

}  // namespace crane::dashboard
