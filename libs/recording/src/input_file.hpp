#pragma once
/// Random access to a file that may be truncated.
#include <cstdint>
#include <filesystem>
#include <string>

namespace crane::recording {

class InputFile {
 public:
  /// @throws ReadError
  explicit InputFile(const std::filesystem::path& file);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }  ///< size at the time of opening, bytes
  /// Bytes [offset, offset + size), fewer at the end of the file. @throws ReadError on an I/O error
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t size) const;

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace crane::recording
