#include "cyclone/security.hpp"

#include <string>

#ifndef CRANE_CYCLONE_PLUGINS
#error "CRANE_CYCLONE_PLUGINS is set by the build"
#endif

namespace crane::bus::cyclone {
namespace {

void load_plugin(dds_qos_t& qos, const std::string& kind, const std::string& library,
                 const std::string& function) {
  const std::string prefix = "dds.sec." + kind + ".library.";
  const std::string path = std::string{CRANE_CYCLONE_PLUGINS "/libdds_security_"} + library + ".so";
  dds_qset_prop(&qos, (prefix + "path").c_str(), path.c_str());
  dds_qset_prop(&qos, (prefix + "init").c_str(), ("init_" + function).c_str());
  dds_qset_prop(&qos, (prefix + "finalize").c_str(), ("finalize_" + function).c_str());
}

}  // namespace

void secure(dds_qos_t& qos, const Credentials& credentials) {
  load_plugin(qos, "auth", "auth", "authentication");
  load_plugin(qos, "crypto", "crypto", "crypto");
  load_plugin(qos, "access", "ac", "access_control");
  const auto file = [&qos](const char* property, const std::string& path) {
    dds_qset_prop(&qos, property, ("file:" + path).c_str());
  };
  file("dds.sec.auth.identity_ca", credentials.identity_ca);
  file("dds.sec.auth.identity_certificate", credentials.identity_certificate);
  file("dds.sec.auth.private_key", credentials.private_key);
  file("dds.sec.access.permissions_ca", credentials.permissions_ca);
  file("dds.sec.access.governance", credentials.governance);
  file("dds.sec.access.permissions", credentials.permissions);
}

}  // namespace crane::bus::cyclone
