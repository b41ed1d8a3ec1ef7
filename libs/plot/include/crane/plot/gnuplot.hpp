#pragma once
/// Runs gnuplot on a script.
#include <filesystem>
#include <stdexcept>
#include <string>

namespace crane::plot {

/// gnuplot is missing or failed, or a file cannot be written. what() names the remedy.
class PictureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Converts `text` to a gnuplot string literal without special characters.
[[nodiscard]] std::string quoted(const std::string& text);

/// Runs `script` and writes a picture of `width` x `height` pixels. `file` appears when it is complete.
/// @param file  ends in .svg or .png. @throws PictureError
void draw_script(const std::filesystem::path& file, double width, double height, const std::string& script);

}  // namespace crane::plot
