#include "crane/files/directory_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "crane/files/complete_file.hpp"

namespace crane::files {

DirectoryLock::DirectoryLock(const std::filesystem::path& directory, IfLocked if_locked)
    : descriptor_{::open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)} {
  const int wait = if_locked == IfLocked::fail ? LOCK_NB : 0;
  if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | wait) == 0) return;
  const bool used = errno == EWOULDBLOCK;
  const std::string reason = used ? "another program writes into it; choose another directory"
                                  : std::generic_category().message(errno);
  if (descriptor_ >= 0) ::close(descriptor_);
  throw WriteError(directory.string() + ": cannot be locked: " + reason);
}

DirectoryLock::~DirectoryLock() { ::close(descriptor_); }

}  // namespace crane::files
