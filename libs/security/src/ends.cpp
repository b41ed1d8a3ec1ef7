#include <algorithm>
#include <ctime>
#include <map>
#include <optional>

#include "crane/security/keys.hpp"
#include "documents.hpp"
#include "openssl.hpp"

namespace crane::security {
namespace {

namespace fs = std::filesystem;

std::optional<std::int64_t> end_of_certificate(const fs::path& file) {
  const auto certificate = openssl::certificate_from(contents_of(file));
  if (!certificate) return {};
  return openssl::validity_of(*certificate).until_s;
}

/// Reads <not_after>2036-11-26T22:00:00</not_after>.
std::optional<std::int64_t> end_of_permissions(const fs::path& file) {
  constexpr std::string_view kTag = "<not_after>";
  const auto text = contents_of(file);
  const auto at = text.find(kTag);
  std::tm parts{};
  if (at == std::string::npos ||
      ::strptime(text.c_str() + at + kTag.size(), "%Y-%m-%dT%H:%M:%S", &parts) == nullptr)
    return {};
  return ::timegm(&parts);
}

}  // namespace

std::string utc_of(std::int64_t time_s) {
  const std::time_t time = time_s;
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
  return text;
}

std::vector<FileEnd> ends(const fs::path& directory) {
  std::map<fs::path, std::optional<std::int64_t>> by_file;
  for (const auto& role : roles()) {
    if (!fs::is_directory(directory / role.name)) continue;
    for (const auto vendor : kVendors) {
      const auto files = identity(directory, role.name, vendor);
      for (const auto* file : {&files.identity_ca, &files.permissions_ca, &files.certificate})
        by_file[*file] = end_of_certificate(*file);
      by_file[files.permissions] = end_of_permissions(files.permissions);
    }
  }
  std::vector<FileEnd> found;
  for (const auto& [file, until_s] : by_file)
    if (until_s) found.push_back({file, *until_s});
  std::ranges::stable_sort(found, {}, &FileEnd::until_s);
  return found;
}

std::string warning_of_end(const fs::path& directory, std::int64_t now_s) {
  constexpr std::int64_t kDay_s = 24 * 3600;
  const auto all = ends(directory);
  if (all.empty() || all.front().until_s > now_s + kWarnBeforeEnd_days * kDay_s) return "";
  return all.front().file.string() + ": ends on " + utc_of(all.front().until_s) + ", in less than " +
         std::to_string(kWarnBeforeEnd_days) +
         " days; then no tool can join the stack, also not to stop the crane; make new keys with `crane keys "
         "make DIR` and give every host its copy";
}

}  // namespace crane::security
