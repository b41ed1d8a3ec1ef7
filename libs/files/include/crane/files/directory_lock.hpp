#pragma once
#include <filesystem>

namespace crane::files {

/// What a program does when another program has the lock of a directory.
enum class IfLocked { wait, fail };

/// Lets one program at a time change the files of a directory. Without the lock, two programs that edit one
/// file lose one of the edits, and a program may read a file of the other program as its own. The directory
/// is locked, not a file, because an edit replaces the file by a new one. The lock ends with this object or
/// with the process.
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
