#include <sys/stat.h>

#include <ctime>
#include <sstream>

#include "crane/security/keys.hpp"
#include "documents.hpp"
#include "openssl.hpp"

namespace crane::security {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMakeAnew = "; make new keys with `crane keys make DIR` and give every host its copy";
constexpr const char* kCopyAnew = "; copy the file again from the directory that `crane keys make` wrote";

/// Collects the problems of the files of one identity.
class Checker {
 public:
  Checker(const Identity& files, std::string_view vendor) : files_{files}, vendor_{vendor} {}

  std::vector<std::string> check() {
    for (const auto* file : {&files_.identity_ca, &files_.certificate, &files_.key, &files_.permissions_ca,
                             &files_.governance, &files_.permissions})
      if (!fs::is_regular_file(*file))
        say(*file, "does not exist or may not be read",
            "; `crane keys show DIR` lists the roles that DIR has keys for");
    if (!problems_.empty()) return problems_;
    check_access();
    check_certificates();
    check_key();
    check_documents();
    return problems_;
  }

 private:
  /// A user who can change these files or directories can replace the authorities, and with them all keys.
  void check_access() {
    const auto own = files_.certificate.parent_path();
    const auto directory = files_.identity_ca.parent_path();
    for (const auto& path : {directory, own.parent_path(), own, files_.identity_ca, files_.permissions_ca,
                             files_.governance, files_.certificate, files_.permissions})
      if (const auto mode = mode_of(path); (mode & (S_IWGRP | S_IWOTH)) != 0)
        say(path, "mode " + octal(mode) + ": other users must not be able to write",
            "; chmod go-w " + path.string());
  }

  /// @return permissions of the file; 0 when it cannot be examined
  static mode_t mode_of(const fs::path& file) {
    struct stat status {};
    return ::stat(file.c_str(), &status) == 0 ? status.st_mode & 07777U : 0;
  }

  void say(const fs::path& file, const std::string& what, const std::string& remedy) {
    problems_.push_back(file.string() + ": " + what + remedy);
  }

  openssl::Certificate load(const fs::path& file) {
    auto certificate = openssl::certificate_from(contents_of(file));
    if (!certificate) {
      say(file, "is no PEM certificate", kCopyAnew);
      return nullptr;
    }
    const auto validity = openssl::validity_of(*certificate);
    const std::int64_t now_s = std::time(nullptr);
    if (now_s > validity.until_s)
      say(file,
          "expired on " + utc_of(validity.until_s) + ", a certificate must be valid now (" + utc_of(now_s) +
              ")",
          kMakeAnew);
    if (now_s < validity.from_s)
      say(file,
          "is valid from " + utc_of(validity.from_s) + ", a certificate must be valid now (" + utc_of(now_s) +
              ")",
          "; set this computer's clock");
    return certificate;
  }

  void check_certificates() {
    const auto authority = load(files_.identity_ca);
    permissions_ca_ = load(files_.permissions_ca);
    certificate_ = load(files_.certificate);
    if (!authority || !certificate_) return;
    if (!openssl::is_signed_by(*certificate_, *authority))
      say(files_.certificate,
          "is not signed by " + files_.identity_ca.string() + ", the authority of this crane", kCopyAnew);
    const auto subject = openssl::subject_of(*certificate_);
    // `crane keys make` writes CN=ROLE.VENDOR.NUMBER; a wrong vendor is reported below.
    if (!subject.starts_with("CN=" + files_.role + "."))
      say(files_.certificate, "subject " + subject + ": is the identity of another role than " + files_.role,
          kCopyAnew);
    if ((openssl::first_hash_byte(*certificate_) < 0x80U) != (vendor_ == "cyclone"))
      say(files_.certificate,
          "subject " + subject + ": its SHA-256 must begin below 0x80 for cyclone and not " +
              "below it for fastdds, because the two vendors shake hands in this order only",
          kMakeAnew);
  }

  void check_key() {
    constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
    if (const auto mode = mode_of(files_.key); (mode & kOthers) != 0)
      say(files_.key, "mode " + octal(mode) + ": other users must have no access to a private key",
          "; chmod 600 " + files_.key.string());
    const auto key = openssl::key_from(contents_of(files_.key));
    if (!key)
      say(files_.key, "is no PEM key", kCopyAnew);
    else if (certificate_ && !openssl::fits(*certificate_, *key))
      say(files_.key, "does not belong to " + files_.certificate.string(), kCopyAnew);
  }

  void check_documents() {
    if (!permissions_ca_) return;
    (void)signed_text(files_.governance);
    const auto permissions = signed_text(files_.permissions);
    if (permissions.empty() || !certificate_) return;
    const auto subject = openssl::subject_of(*certificate_);
    if (permissions.find("<subject_name>" + subject + "</subject_name>") == std::string::npos)
      say(files_.permissions, "does not name " + subject + ", the subject of " + files_.certificate.string(),
          kCopyAnew);
    else
      check_topics(permissions, subject);
  }

  /// Compares the permissions with those of the role, except for the validity.
  void check_topics(const std::string& permissions, const std::string& subject) {
    const auto* role = role_named(files_.role);
    if (role == nullptr) return;
    const auto without_validity = [](std::string text) {
      std::erase(text, '\r');  // of the lines of S/MIME
      const auto begin = text.find("<validity>"), end = text.find("</validity>");
      if (begin < end && end != std::string::npos) text.erase(begin, end - begin);
      return text;
    };
    if (without_validity(permissions) != without_validity(permissions_document(*role, subject, {})))
      say(files_.permissions, "permits other topics than those of the role " + files_.role, kMakeAnew);
  }

  std::string signed_text(const fs::path& file) {
    auto text = openssl::verified(contents_of(file), *permissions_ca_);
    if (text.empty())
      say(file,
          "was changed, or is not signed by " + files_.permissions_ca.string() +
              ": its signature does not match its content",
          kCopyAnew);
    return text;
  }

  static std::string octal(mode_t mode) {
    std::ostringstream text;
    text << std::oct << mode;
    return text.str();
  }

  Identity files_;
  std::string_view vendor_;
  openssl::Certificate certificate_, permissions_ca_;
  std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> problems(const Identity& identity, std::string_view vendor) {
  return Checker{identity, vendor}.check();
}

std::vector<Entry> entries(const fs::path& directory) {
  std::vector<Entry> found;
  for (const auto& role : roles()) {
    if (!fs::is_directory(directory / role.name)) continue;
    for (const auto vendor : kVendors) {
      const auto files = identity(directory, role.name, vendor);
      Entry entry{&role, vendor, "", 0, problems(files, vendor)};
      if (const auto certificate = openssl::certificate_from(contents_of(files.certificate))) {
        entry.subject = openssl::subject_of(*certificate);
        entry.until_s = openssl::validity_of(*certificate).until_s;
      }
      found.push_back(std::move(entry));
    }
  }
  return found;
}

}  // namespace crane::security
