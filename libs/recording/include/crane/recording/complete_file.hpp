#pragma once
/// A file that appears, or replaces an existing file, only when it is complete.
#include <filesystem>
#include <span>

namespace crane::recording {

class CompleteFile {
 public:
  /// Names FILE.partial, which the caller writes. If `file` is a symbolic link, its target is replaced.
  /// @param sources  files that are read while `file` is written
  /// @throws WriteError when `file` exists and is no regular file, is one of `sources`, or is a link to a
  /// missing file
  explicit CompleteFile(const std::filesystem::path& file,
                        std::span<const std::filesystem::path> sources = {});
  /// Removes FILE.partial, unless publish() was called.
  ~CompleteFile();
  CompleteFile(const CompleteFile&) = delete;
  CompleteFile& operator=(const CompleteFile&) = delete;

  [[nodiscard]] const std::filesystem::path& partial() const { return partial_; }
  /// Gives FILE.partial the permissions of the replaced file and renames it to FILE. @throws WriteError
  void publish();

 private:
  std::filesystem::path file_, partial_;
  bool published_ = false;
};

}  // namespace crane::recording
