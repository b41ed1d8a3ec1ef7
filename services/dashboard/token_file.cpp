#include "dashboard/token_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "crane/configuration/rig.hpp"
#include "dashboard/access.hpp"

namespace crane::dashboard {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw configuration::ConfigurationError({"--operator-token " + file.string() + ": " + why});
}

void make(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) refuse(file, "the file cannot be created");
  const auto text = random_token() + "\n";
  const bool written = ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::close(descriptor);
  if (!written) refuse(file, "the file cannot be written");
}

}  // namespace

std::string read_or_make_token(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) make(file);
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) refuse(file, "the file cannot be read");
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    refuse(file, "other users can read or change the file: run chmod 600, and write a new token to it");
  std::string token;
  std::getline(std::ifstream{file}, token);
  if (token.size() < kShortestToken)
    refuse(file, "the token must have at least 16 characters: remove the file, and the next start makes one");
  return token;
}

}  // namespace crane::dashboard
