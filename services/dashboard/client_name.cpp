#include "dashboard/client_name.hpp"

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace crane::dashboard {
namespace {

namespace asio = boost::asio;
using Endpoint = asio::ip::tcp::endpoint;

void put(__be32* words, const asio::ip::address& address) {
  if (address.is_v4()) {
    const auto bytes = address.to_v4().to_bytes();
    std::memcpy(words, bytes.data(), bytes.size());
  } else {
    const auto bytes = address.to_v6().to_bytes();
    std::memcpy(words, bytes.data(), bytes.size());
  }
}

/// Asks the kernel (sock_diag(7)) for the user id that owns the socket with these two endpoints.
std::optional<std::uint32_t> owner_of(const Endpoint& own, const Endpoint& other) {
  struct {
    nlmsghdr header;
    inet_diag_req_v2 socket;
  } request{};
  request.header = {.nlmsg_len = sizeof request,
                    .nlmsg_type = SOCK_DIAG_BY_FAMILY,
                    .nlmsg_flags = NLM_F_REQUEST,
                    .nlmsg_seq = 0,
                    .nlmsg_pid = 0};
  request.socket.sdiag_family = own.address().is_v4() ? AF_INET : AF_INET6;
  request.socket.sdiag_protocol = IPPROTO_TCP;
  request.socket.idiag_states = ~0U;
  request.socket.id.idiag_sport = htons(own.port());
  request.socket.id.idiag_dport = htons(other.port());
  put(request.socket.id.idiag_src, own.address());
  put(request.socket.id.idiag_dst, other.address());
  std::ranges::fill(request.socket.id.idiag_cookie, INET_DIAG_NOCOOKIE);

  const int kernel = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG);
  if (kernel < 0) return std::nullopt;
  alignas(nlmsghdr) std::array<char, 8192> buffer{};
  const bool sent = ::send(kernel, &request, sizeof request, 0) == sizeof request;
  const auto size = sent ? ::recv(kernel, buffer.data(), buffer.size(), MSG_DONTWAIT) : -1;
  ::close(kernel);
  const auto* header = reinterpret_cast<const nlmsghdr*>(buffer.data());
  if (size < static_cast<ssize_t>(NLMSG_LENGTH(sizeof(inet_diag_msg))) ||
      header->nlmsg_type != SOCK_DIAG_BY_FAMILY)
    return std::nullopt;
  const auto* found = reinterpret_cast<const inet_diag_msg*>(buffer.data() + NLMSG_HDRLEN);
  if (found->idiag_state != TCP_ESTABLISHED) return std::nullopt;  // an end that is closed has no owner
  return found->idiag_uid;
}

}  // namespace

Client client_of(const asio::ip::tcp::socket& socket) {
  boost::system::error_code error;
  const auto other = socket.remote_endpoint(error);
  auto address = other.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    address = asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
  if (address.is_loopback()) {
    const auto user = owner_of(other, socket.local_endpoint(error));
    return {.foreign = false, .name = user ? "user " + std::to_string(*user) : "an unknown user"};
  }
  if (address.is_v4()) return {.foreign = true, .name = address.to_string()};
  auto network = address.to_v6().to_bytes();
  std::fill(network.begin() + 8, network.end(), std::uint8_t{0});
  return {.foreign = true, .name = asio::ip::address_v6{network}.to_string()};
}

}  // namespace crane::dashboard
