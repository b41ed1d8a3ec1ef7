#include "fastdds/security.hpp"

#include <string>

namespace crane::bus::fastdds {

void secure(eprosima::fastdds::dds::DomainParticipantQos& qos, const Credentials& credentials) {
  auto& properties = qos.properties().properties();
  properties.emplace_back("dds.sec.auth.plugin", "builtin.PKI-DH");
  properties.emplace_back("dds.sec.access.plugin", "builtin.Access-Permissions");
  properties.emplace_back("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
  const auto file = [&properties](const std::string& property, const std::string& path) {
    properties.emplace_back("dds.sec." + property, "file://" + path);
  };
  const std::string identity = "auth.builtin.PKI-DH.", access = "access.builtin.Access-Permissions.";
  file(identity + "identity_ca", credentials.identity_ca);
  file(identity + "identity_certificate", credentials.identity_certificate);
  file(identity + "private_key", credentials.private_key);
  file(access + "permissions_ca", credentials.permissions_ca);
  file(access + "governance", credentials.governance);
  file(access + "permissions", credentials.permissions);
}

}  // namespace crane::bus::fastdds
