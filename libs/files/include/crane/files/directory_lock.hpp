#pragma once
#include <filesystem>

namespace crane::files {

/// What a program does when another program has the lock of a directory.
enum class IfLocked { wait, fail };

/// Lets one program at a time change the files of a directory: otherwise, of two programs that change the
/// text of a file, the second one removes the change of the first one, and a program may read a file of the
/// other one as its own. The lock belongs to the directory, because a replaced file is a new one. It ends
/// with this object or with the process.
class DirectoryLock {
 public:
  /// @throws WriteError, with IfLocked::fail also when another program has the lock
  explicit DirectoryLock(const std::filesystem::path& directory, IfLocked if_locked = IfLocked::wait);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace crane::files
