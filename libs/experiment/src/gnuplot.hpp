#pragma once
/// Runs gnuplot on a script.
#include <string>

namespace crane::experiment {

/// `text` as a gnuplot string that is taken literally.
[[nodiscard]] std::string quoted(const std::string& text);

/// @throws PictureError when gnuplot is missing, or with what it complained about
void run_gnuplot(const std::string& script);

}  // namespace crane::experiment
