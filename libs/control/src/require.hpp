#pragma once
/// Checks numbers from files. Every problem has the form "name = value: rule".
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace crane::control {

struct Requirements {
  std::vector<std::string> found;

  void require(bool fulfilled, const char* name, double value, const std::string& rule) {
    if (fulfilled) return;
    std::ostringstream text;
    text << name << " = " << value << ": " << rule;
    found.push_back(text.str());
  }
  /// NaN is outside every range.
  void in_range(const char* name, double value, double low, double high) {
    require(value >= low && value <= high, name, value,
            "must be in [" + text_of(low) + ", " + text_of(high) + "]");
  }
  void above_up_to(const char* name, double value, double low, double high) {
    require(value > low && value <= high, name, value,
            "must be in (" + text_of(low) + ", " + text_of(high) + "]");
  }
  /// @throws std::invalid_argument with all problems
  void throw_if_any() const {
    if (found.empty()) return;
    std::string text;
    for (const auto& problem : found) text += (text.empty() ? "" : "; ") + problem;
    throw std::invalid_argument(text);
  }

 private:
  static std::string text_of(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  }
};

}  // namespace crane::control
