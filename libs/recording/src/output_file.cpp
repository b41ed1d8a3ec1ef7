#include "output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "crane/recording/mcap_writer.hpp"

namespace crane::recording {

OutputFile::OutputFile(const std::filesystem::path& file, bool replace) : name_{file.string()} {
  descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (replace ? O_TRUNC : O_EXCL), 0644);
  if (descriptor_ < 0) fail("cannot create");
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::fail(std::string_view action) {
  const std::string reason = std::generic_category().message(errno);
  failure_ = name_ + ": " + std::string{action} + ": " + reason;
  throw WriteError(failure_);
}

void OutputFile::require_good() const {
  if (!failure_.empty()) throw WriteError(failure_);
}

void OutputFile::append(std::string_view bytes) {
  require_good();
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int reason = errno;
      // Removes the incomplete part, which a reader would report as damage. ftruncate fails for a device; the
      // error has no consequence.
      (void)::ftruncate(descriptor_, static_cast<off_t>(size_));
      errno = reason;
      fail("cannot write");
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  size_ += bytes.size();
}

bool OutputFile::removed() const {
  struct stat status {};
  return descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0 && status.st_nlink == 0;
}

void OutputFile::sync() {
  require_good();
  // a device or a pipe has nothing to synchronise (EINVAL)
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL) fail("cannot write to the disk");
}

void OutputFile::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (descriptor >= 0 && ::close(descriptor) != 0) fail("cannot close");
}

}  // namespace crane::recording
