#pragma once
#include <filesystem>
#include <string>

namespace crane::files {

/// A new temporary directory that only this user can read. Its name is unpredictable: no other user can
/// prepare links at the paths of its files. The destructor deletes the directory.
class TemporaryDirectory {
 public:
  /// @param name  begin of the name: "crane_replay" @throws WriteError
  explicit TemporaryDirectory(const std::string& name);
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace crane::files
