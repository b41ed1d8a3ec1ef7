#pragma once
/// A file to which data are only appended. If the disk is full, the file removes the incomplete part.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace crane::recording {

class OutputFile {
 public:
  /// Creates the file; truncates an existing one, or fails unless `replace`. @throws WriteError
  explicit OutputFile(const std::filesystem::path& file, bool replace = true);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends all of `bytes` or nothing. @throws WriteError; after a failure every further call throws
  void append(std::string_view bytes);
  /// @throws WriteError
  void sync();
  /// @throws WriteError; some file systems report a full disk only in this call
  void close();
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] bool removed() const;  ///< true: no directory contains the file any more
  /// @throws WriteError, with the first failure, when a call has failed
  void require_good() const;

 private:
  [[noreturn]] void fail(std::string_view action);

  std::string name_;
  std::string failure_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace crane::recording
