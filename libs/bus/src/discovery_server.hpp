#pragma once
/// Address of a Discovery Server of Fast DDS.
#include <cstdint>
#include <string>

namespace crane::bus {

struct DiscoveryServer {
  std::string host;
  std::uint32_t port = 11811;  ///< default of `fast-discovery-server`
};

/// @param text  "HOST" or "HOST:PORT"
/// @return port 0 when the port is not a number from 1 to 65535
[[nodiscard]] DiscoveryServer discovery_server_in(const std::string& text);

}  // namespace crane::bus
