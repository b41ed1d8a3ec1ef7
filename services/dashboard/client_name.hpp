#pragma once
/// Finds out which client has opened a connection.
#include <boost/asio/ip/tcp.hpp>

#include "dashboard/connection_limits.hpp"

namespace crane::dashboard {

/// @return a foreign client for an address outside the loop-back; otherwise one client per user of this
/// computer, or one client for all users when the kernel does not know the owner of the other end. All
/// computers of one IPv6 network (64 bits) are one client, because one computer can use all its addresses.
[[nodiscard]] Client client_of(const boost::asio::ip::tcp::socket& socket);

}  // namespace crane::dashboard
