#include "dashboard/server.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <iostream>

#include "crane/runtime/process.hpp"
#include "dashboard/client_name.hpp"
#include "dashboard/http_session.hpp"
#include "dashboard/viewer_session.hpp"
#include "observation/observer.hpp"

namespace crane::dashboard {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// Length of the kernel's queue of new connections. When the queue is full, a client tries again after 1 s,
/// then 2 s. The server accepts thousands of connections per second.
constexpr int kBacklog = 512;

}  // namespace

Server::Server(const std::string& address, unsigned short port, About about, AccessRules rules,
               std::function<void(const stack::OperatorRequest&, Answered)> send, const RunsOptions& runs)
    : acceptor_{context_},
      timer_{context_},
      retry_{context_},
      rules_{std::move(rules)},
      model_{std::move(about)},
      api_{model_, rules_, std::move(send), [this] { return counts(); }, runs} {
  const tcp::endpoint endpoint{asio::ip::make_address(address), port};
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(tcp::acceptor::reuse_address{true});
  acceptor_.bind(endpoint);
  acceptor_.listen(kBacklog);
}

unsigned short Server::port() const { return acceptor_.local_endpoint().port(); }

void Server::run() {
  accept();
  beat();
  while (!context_.stopped()) {
    try {
      context_.run();
    } catch (const std::exception& error) {  // ends only the connection whose handler threw
      if (++failures_ <= kMostReportedFailures)
        std::cerr << "crane dashboard: a connection failed: " << error.what() << '\n';
    }
  }
}

void Server::stop() { context_.stop(); }

void Server::post(std::function<void()> work) { asio::post(context_, std::move(work)); }

void Server::put(std::vector<observation::SamplePtr> samples) {
  if (inbox_.put(std::move(samples))) asio::post(context_, [this] { take_samples(); });
}

void Server::set_other_versions(std::vector<bus::OtherVersion> others) {
  post([this, others = std::move(others)]() mutable { model_.set_other_versions(std::move(others)); });
}

void Server::take_samples() {
  for (const auto& batch : inbox_.take_all())
    for (const auto& sample : batch) {
      model_.add(sample);
      for (const auto& viewer : std::vector(viewers_.begin(), viewers_.end())) viewer->send_sample(sample);
    }
}

void Server::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!error) {
      accept();  // first, because the code below may throw
      return welcome(std::move(socket));
    }
    // After an error, for example without a free descriptor, the wait avoids a busy loop.
    retry_.expires_after(std::chrono::milliseconds{200});
    retry_.async_wait([this](error_code) { accept(); });
  });
}

void Server::welcome(tcp::socket socket) {
  error_code error;
  (void)socket.remote_endpoint(error);
  if (error) return;
  auto client = client_of(socket);
  if (!limits_->has_place(client, Kind::connection) && !displace_for(client, Kind::connection)) return;
  auto admission = std::make_unique<Admission>(limits_, client);
  std::erase_if(displaceable_, [](const DisplaceableConnection& entry) { return entry.session.expired(); });
  displaceable_.push_back({start_http_session(std::move(socket), *this, std::move(admission)),
                           std::move(client), Kind::connection});
}

bool Server::admits_viewer(const Client& client) {
  return limits_->has_place(client, Kind::viewer) || displace_for(client, Kind::viewer);
}

bool Server::displace_for(const Client& client, Kind kind) {
  auto best = displaceable_.end();
  const auto rank = [&](const DisplaceableConnection& entry) {
    return std::pair{limits_->open(entry.client, kind), entry.kind == Kind::connection};
  };
  for (auto entry = displaceable_.begin(); entry != displaceable_.end(); ++entry) {
    if (entry->session.expired() || (kind == Kind::viewer && entry->kind != Kind::viewer)) continue;
    const bool own = entry->client == client && entry->kind == Kind::connection;
    if (!own && !limits_->must_yield(entry->client, client, kind)) continue;
    if (best == displaceable_.end() || rank(*entry) > rank(*best)) best = entry;
  }
  if (best == displaceable_.end()) return false;
  const auto session = best->session.lock();
  displaceable_.erase(best);
  session->displace();
  return true;
}

void Server::beat() {
  timer_.expires_after(kFramePeriod);  // first, because the code below may throw
  timer_.async_wait([this](error_code error) {
    if (!error) beat();
  });
  api_.poll();
  const auto now_ns = runtime::monotonic_ns();
  const auto log_ns = observation::log_now_ns();
  for (const auto document : model_.poll(now_ns, log_ns)) {
    const auto& text = model_.text(document);
    const auto bytes = std::make_shared<const std::vector<std::uint8_t>>(text.begin(), text.end());
    for (const auto& viewer : std::vector(viewers_.begin(), viewers_.end()))
      viewer->send_document(document, bytes, log_ns);
  }
  for (const auto& viewer : std::vector(viewers_.begin(), viewers_.end())) {
    viewer->send_time(log_ns);
    viewer->flush();
  }
}

void Server::leave(const std::shared_ptr<ViewerSession>& viewer) {
  counts_.dropped_messages += viewer->dropped();
  viewers_.erase(viewer);
}

ServerCounts Server::counts() const {
  auto result = counts_;
  result.viewers = viewers_.size();
  result.connections = limits_->open();
  result.lost_samples = inbox_.refused();
  for (const auto& viewer : viewers_) result.dropped_messages += viewer->dropped();
  return result;
}

}  // namespace crane::dashboard
