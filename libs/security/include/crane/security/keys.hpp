#pragma once
/// The directory of keys that `crane keys make` writes and every process of a secured crane reads:
///
///   DIR/identity_ca.pem       signs the certificate of every identity
///   DIR/permissions_ca.pem    signs governance and permissions
///   DIR/governance.smime      what the bus encrypts and whom it lets in
///   DIR/private/              keys of both authorities: needed by `crane keys make` only; keep them off the
///   rig DIR/ROLE/VENDOR/          certificate.pem, key.pem, permissions.smime of one identity
///
/// A role has one identity per DDS implementation: the participant with the lower hash of its certificate's
/// subject starts the handshake, and a Fast DDS process understands a Cyclone DDS process only when the
/// latter starts.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "crane/security/roles.hpp"

namespace crane::security {

/// Files of one identity, as a participant needs them.
struct Identity {
  std::filesystem::path identity_ca, certificate, key, permissions_ca, governance, permissions;
};
/// Paths only; nothing is read.
[[nodiscard]] Identity identity(const std::filesystem::path& directory, std::string_view role,
                                std::string_view vendor);

inline constexpr std::string_view kVendors[] = {"cyclone", "fastdds"};

struct Validity {
  std::int64_t from_s = 0, until_s = 0;  ///< seconds since 1970
};
/// From an hour ago, because clocks of two hosts differ, for `days`.
[[nodiscard]] Validity valid_for(int days);

/// Makes authorities and one identity per role and vendor. @throws std::runtime_error when `directory` exists
/// and is not empty, or a file cannot be written
void make(const std::filesystem::path& directory, const Validity& validity);

/// What stands against the use of one identity now, each with file, value, rule and remedy.
[[nodiscard]] std::vector<std::string> problems(const Identity& identity, std::string_view vendor);

/// One line of `crane keys show`.
struct Entry {
  const Role* role;
  std::string_view vendor;
  std::string subject;
  std::int64_t until_s = 0;
  std::vector<std::string> problems;
};
/// Every identity that `directory` holds; a copy for another host may hold some of the roles only.
[[nodiscard]] std::vector<Entry> entries(const std::filesystem::path& directory);

}  // namespace crane::security
