#pragma once
/// The directory of keys, which `crane keys make` writes and every process of a secured crane reads:
///
///   DIR/identity_ca.pem       signs the certificates of all identities
///   DIR/permissions_ca.pem    signs governance and permissions
///   DIR/governance.smime      rules of the domain: authentication, encryption, access control
///   DIR/private/              keys of both authorities for `crane keys make`; keep them off the rig
///   DIR/ROLE/VENDOR/          certificate.pem, key.pem, permissions.smime of one identity
///
/// A role has one identity per DDS implementation. The participant whose certificate has the subject with the
/// lower hash starts the handshake. A handshake between Fast DDS and Cyclone DDS succeeds only when Cyclone
/// DDS starts it.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "crane/security/roles.hpp"

namespace crane::security {

/// Files that a participant with this identity needs.
struct Identity {
  std::filesystem::path identity_ca, certificate, key, permissions_ca, governance, permissions;
  std::string role;  ///< that the files must belong to
};
/// Returns the paths only; reads no file.
[[nodiscard]] Identity identity(const std::filesystem::path& directory, std::string_view role,
                                std::string_view vendor);

inline constexpr std::string_view kVendors[] = {"cyclone", "fastdds"};

struct Validity {
  std::int64_t from_s = 0, until_s = 0;  ///< seconds since 1970
};
/// Begins an hour ago, because the clocks of two hosts differ, and ends after `days`.
[[nodiscard]] Validity valid_for(int days);

/// Makes authorities and one identity per role and vendor. @throws std::runtime_error when `directory`
/// exists and is not an empty directory, or when a file cannot be written; make() then removes its files
void make(const std::filesystem::path& directory, const Validity& validity);

/// Reasons why the identity cannot be used now, each with file, value, rule and remedy. The files must belong
/// to the role, and other users must not be able to change them or their directories.
[[nodiscard]] std::vector<std::string> problems(const Identity& identity, std::string_view vendor);

/// A certificate or permissions file and the end of its validity.
struct FileEnd {
  std::filesystem::path file;
  std::int64_t until_s = 0;  ///< seconds since 1970
};
/// Certificates and permissions of all identities in `directory`, the earliest end first. Each file occurs
/// once; a file whose end cannot be read is omitted.
[[nodiscard]] std::vector<FileEnd> ends(const std::filesystem::path& directory);
/// "2026-12-29 10:00 UTC"
[[nodiscard]] std::string utc_of(std::int64_t time_s);

/// Time before the end of validity from which `crane up` warns [days]: long enough to make new keys and to
/// copy them to every host at the next maintenance. A running stack continues after the end, but no tool can
/// then join it to stop the crane.
inline constexpr int kWarnBeforeEnd_days = 30;
/// A warning that names the first file that ends within kWarnBeforeEnd_days after `now_s`, with its date;
/// empty: no file ends so soon.
[[nodiscard]] std::string warning_of_end(const std::filesystem::path& directory, std::int64_t now_s);

/// One line of `crane keys show`.
struct Entry {
  const Role* role;
  std::string_view vendor;
  std::string subject;
  std::int64_t until_s = 0;
  std::vector<std::string> problems;
};
/// All identities in `directory`. A copy for another host may contain only some of the roles.
[[nodiscard]] std::vector<Entry> entries(const std::filesystem::path& directory);

}  // namespace crane::security
