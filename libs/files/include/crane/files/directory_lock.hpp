#pragma once
#include <filesystem>

namespace crane::files {

/// Lets one program at a time read a file of a directory, change its text and replace it: otherwise, of two
/// programs that read the same text, the second one removes the change of the first one. The lock belongs to
/// the directory, because a replaced file is a new one. It ends with this object or with the process.
class DirectoryLock {
 public:
  /// Waits until no other program has the lock. @throws WriteError
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace crane::files
