#include "crane/security/keys.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include "documents.hpp"
#include "openssl.hpp"

namespace crane::security {
namespace {

namespace fs = std::filesystem;

void make_directory(const fs::path& directory) {
  if (::mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST)
    throw std::runtime_error{"cannot make directory " + directory.string() + ": " + std::strerror(errno)};
}

/// Creates the file with read permission for its owner only.
void write(const fs::path& file, const std::string& text) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const bool written =
      descriptor >= 0 && ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  const bool closed = descriptor < 0 || ::close(descriptor) == 0;
  if (!written || !closed)
    throw std::runtime_error{"cannot write " + file.string() + ": " + std::strerror(error)};
}

struct Authority {
  openssl::Key key;
  openssl::Certificate certificate;
};
Authority make_authority(const std::string& name, const fs::path& directory, const Validity& validity) {
  Authority authority{openssl::make_key(), nullptr};
  authority.certificate =
      openssl::certify("crane " + name, *authority.key, validity, nullptr, *authority.key);
  write(directory / (name + ".pem"), openssl::pem_of(*authority.certificate));
  write(directory / "private" / (name + "_key.pem"), openssl::pem_of(*authority.key));
  return authority;
}

/// Subject with a hash for which Cyclone DDS starts every handshake with Fast DDS.
std::string common_name(std::string_view role, std::string_view vendor) {
  for (int number = 0;; ++number) {
    auto name = std::string{role} + "." + std::string{vendor} + "." + std::to_string(number);
    if ((openssl::first_hash_byte(name) < 0x80U) == (vendor == "cyclone")) return name;
  }
}

void make_identity(const fs::path& directory, const Role& role, std::string_view vendor,
                   const Validity& validity, const Authority& identities, const Authority& permissions) {
  const auto files = identity(directory, role.name, vendor);
  make_directory(directory / role.name);
  make_directory(files.key.parent_path());
  const auto key = openssl::make_key();
  const auto certificate = openssl::certify(common_name(role.name, vendor), *key, validity,
                                            identities.certificate.get(), *identities.key);
  write(files.key, openssl::pem_of(*key));
  write(files.certificate, openssl::pem_of(*certificate));
  write(files.permissions,
        openssl::sign(permissions_document(role, openssl::subject_of(*certificate), validity),
                      *permissions.certificate, *permissions.key));
}

}  // namespace

Identity identity(const fs::path& directory, std::string_view role, std::string_view vendor) {
  const auto own = directory / role / vendor;
  return {.identity_ca = directory / "identity_ca.pem",
          .certificate = own / "certificate.pem",
          .key = own / "key.pem",
          .permissions_ca = directory / "permissions_ca.pem",
          .governance = directory / "governance.smime",
          .permissions = own / "permissions.smime",
          .role = std::string{role}};
}

Validity valid_for(int days) {
  constexpr std::int64_t kHour_s = 3600, kDay_s = 24 * kHour_s;
  const std::int64_t now_s = std::time(nullptr);
  return {now_s - kHour_s, now_s + days * kDay_s};
}

namespace {

void fill(const fs::path& directory, const Validity& validity) {
  ::chmod(directory.c_str(), 0700);
  make_directory(directory / "private");
  const auto identities = make_authority("identity_ca", directory, validity);
  const auto permissions = make_authority("permissions_ca", directory, validity);
  write(directory / "governance.smime",
        openssl::sign(governance_document(), *permissions.certificate, *permissions.key));
  for (const auto& role : roles())
    for (const auto vendor : kVendors)
      make_identity(directory, role, vendor, validity, identities, permissions);
}

}  // namespace

void make(const fs::path& directory, const Validity& validity) {
  const bool exists = fs::exists(directory);
  if (exists && !fs::is_directory(directory))
    throw std::runtime_error{directory.string() + " is no directory; name another one"};
  if (exists && !fs::is_empty(directory))
    throw std::runtime_error{directory.string() +
                             " is not empty, and keys are never overwritten: name another directory, " +
                             "or remove this one and give the new keys to every process"};
  if (directory.has_parent_path()) fs::create_directories(directory.parent_path());
  make_directory(directory);
  try {
    fill(directory, validity);
  } catch (...) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator{directory, ignored})
      fs::remove_all(entry.path(), ignored);
    if (!exists) fs::remove(directory, ignored);
    throw;
  }
}

}  // namespace crane::security
