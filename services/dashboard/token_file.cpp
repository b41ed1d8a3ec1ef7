#include "dashboard/token_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

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

/// The opened token file. A link may name the file of another program, and a pipe may never end: both are
/// refused.
struct Descriptor {
  explicit Descriptor(const std::filesystem::path& file)
      : number{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)} {
    if (number < 0) refuse(file, errno == ELOOP ? "the file is a link" : "the file cannot be read");
  }
  ~Descriptor() { ::close(number); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number;
};

}  // namespace

std::string read_or_make_token(const std::filesystem::path& file) {
  if (!std::filesystem::exists(std::filesystem::symlink_status(file))) make(file);
  const Descriptor opened{file};
  struct stat status {};
  if (::fstat(opened.number, &status) != 0 || !S_ISREG(status.st_mode)) refuse(file, "is not a regular file");
  if (status.st_uid != ::geteuid()) refuse(file, "the file belongs to another user");
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    refuse(file, "other users can read or change the file: run chmod 600, and write a new token to it");
  std::string text(kLongestToken + 1, '\0');
  const auto size = ::read(opened.number, text.data(), text.size());
  if (size < 0) refuse(file, "the file cannot be read");
  text.resize(static_cast<std::size_t>(size));
  const std::string token = text.substr(0, text.find('\n'));
  if (token.size() < kShortestToken)
    refuse(file, "the token must have at least 16 characters: remove the file, and the next start makes one");
  if (token.size() > kLongestToken) refuse(file, "the token must have at most 1024 characters");
  return token;
}

}  // namespace crane::dashboard
