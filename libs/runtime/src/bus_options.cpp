/// Options with which a process joins the bus: command line, keys, and the rule that other hosts may reach a
/// writing process only with keys.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "crane/configuration/rig.hpp"
#include "crane/runtime/process.hpp"
#include "crane/runtime/process_name.hpp"
#include "crane/security/keys.hpp"

namespace crane::runtime {
namespace {

bool is_loop_back(const std::string& address) { return address.starts_with("127."); }
bool on_loop_back(const std::vector<std::string>& interfaces) {
  return std::all_of(interfaces.begin(), interfaces.end(), is_loop_back);
}

bus::Credentials credentials_for(const BusOptions& options, crane_Source source) {
  const auto* role = security::role_of(source);
  if (role == nullptr)
    throw configuration::ConfigurationError({"--secure " + options.secure + ": processes of kind " +
                                             std::string{process_name(source)} +
                                             " have no role, so that no identity can be chosen"});
  const auto files =
      security::identity(std::filesystem::absolute(options.secure), role->name, options.vendor);
  if (auto problems = security::problems(files, options.vendor); !problems.empty())
    throw configuration::ConfigurationError(std::move(problems));
  return {.identity_ca = files.identity_ca,
          .identity_certificate = files.certificate,
          .private_key = files.key,
          .permissions_ca = files.permissions_ca,
          .governance = files.governance,
          .permissions = files.permissions};
}

void refuse_open_network(const BusOptions& options) {
  const auto open = std::find_if_not(options.interfaces.begin(), options.interfaces.end(), is_loop_back);
  if (open == options.interfaces.end()) return;
  throw configuration::ConfigurationError(
      {"--interface " + *open +
       ": every host that reaches this address could command the crane; make keys (crane keys make DIR) and "
       "add "
       "--secure DIR to every program of the crane, or add --insecure on a network of the crane's own"});
}

}  // namespace

void add_bus_options(CLI::App& app, BusOptions& options) {
  app.add_option("--dds", options.vendor, "DDS implementation: cyclone or fastdds")
      ->check(CLI::IsMember({"cyclone", "fastdds"}))
      ->capture_default_str();
  app.add_option("--domain", options.domain, "DDS domain, 0 to 100")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  app.add_option("--crane", options.crane, "name of the crane: separates several cranes in one domain")
      ->capture_default_str();
  app.add_option("--interface", options.interfaces,
                 "address of a network interface to use (repeatable); 127.0.0.1: no sample leaves this host")
      ->capture_default_str();
  auto* peer =
      app.add_option("--peer", options.peers,
                     "address of a host to discover by unicast (repeatable); disables multicast discovery");
  app.add_option(
         "--discovery-server", options.discovery_server,
         "HOST or HOST:PORT of a Discovery Server of Fast DDS (fast-discovery-server), which replaces "
         "multicast; only with --dds fastdds")
      ->excludes(peer);
  auto* secure = app.add_option(
      "--secure", options.secure,
      "directory of keys (crane keys make): encrypt all traffic, and accept only programs with "
      "keys of the same authority, each with the rights of its role");
  app.add_flag("--insecure", options.insecure,
               "permit --interface without keys: every host that reaches it can then command the crane")
      ->excludes(secure);
}

bus::Options bus_options(const BusOptions& options, std::string participant, crane_Source source,
                         std::uint32_t epoch) {
  const bool writes = source != crane_SOURCE_MONITOR && source != crane_SOURCE_NONE;
  if (options.secure.empty() && !options.insecure && writes) refuse_open_network(options);
  bus::Options result;
  const auto vendor = bus::vendor_from_string(options.vendor);
  if (!vendor)
    throw configuration::ConfigurationError({"--dds " + options.vendor + ": must be cyclone or fastdds"});
  result.vendor = *vendor;
  result.domain = options.domain;
  result.crane = options.crane;
  result.participant = std::move(participant);
  result.source = source;
  result.epoch = epoch;
  result.interfaces = options.interfaces;
  result.peers = options.peers;
  result.discovery_server = options.discovery_server;
  if (!options.secure.empty()) result.credentials = credentials_for(options, source);
  return result;
}

bool is_insecure(const bus::Options& options) {
  return options.vendor != bus::Vendor::memory && !options.credentials && !on_loop_back(options.interfaces);
}

std::vector<std::string> arguments(const BusOptions& options) {
  std::vector<std::string> result{"--dds",   options.vendor, "--domain", std::to_string(options.domain),
                                  "--crane", options.crane};
  for (const auto& interface : options.interfaces) result.insert(result.end(), {"--interface", interface});
  for (const auto& peer : options.peers) result.insert(result.end(), {"--peer", peer});
  if (!options.discovery_server.empty())
    result.insert(result.end(), {"--discovery-server", options.discovery_server});
  if (!options.secure.empty())
    result.insert(result.end(), {"--secure", std::filesystem::absolute(options.secure).string()});
  if (options.insecure) result.emplace_back("--insecure");
  return result;
}

}  // namespace crane::runtime
