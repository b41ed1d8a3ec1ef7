#pragma once
/// One HTTP connection: handles requests one after the other, each within limits; may become a WebSocket.
#include <boost/asio/ip/tcp.hpp>
#include <vector>

#include "dashboard/server.hpp"

namespace crane::dashboard {

/// The session keeps itself alive until the connection ends, or until it becomes a WebSocket.
std::weak_ptr<Displaceable> start_http_session(boost::asio::ip::tcp::socket socket, Server& server,
                                               std::unique_ptr<Admission> admission);

}  // namespace crane::dashboard
