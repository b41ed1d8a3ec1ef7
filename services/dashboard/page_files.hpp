#pragma once
/// The files of the page. The program embeds or generates them, so that a request cannot reach the file
/// system.
#include <span>
#include <string_view>

namespace crane::dashboard {

struct PageFile {
  std::string_view path;  ///< "/operate.js"; the start page is "/"
  std::string_view media_type;
  std::string_view bytes;
};
[[nodiscard]] std::span<const PageFile> page_files();
/// @return nullptr when no file has this path
[[nodiscard]] const PageFile* find_page_file(std::string_view path);

}  // namespace crane::dashboard
