#pragma once
/// Finds out which client has opened a connection.
#include <boost/asio/ip/tcp.hpp>

#include "dashboard/connection_limits.hpp"

namespace crane::dashboard {

/// @return a foreign client for every address outside the loop-back. Users of this computer are distinguished
/// when the kernel knows the owner of the other end; otherwise all of them are one client. Computers of one
/// IPv6 network (64 bits) are one client, because one computer can use all addresses of its network.
[[nodiscard]] Client client_of(const boost::asio::ip::tcp::socket& socket);

}  // namespace crane::dashboard
