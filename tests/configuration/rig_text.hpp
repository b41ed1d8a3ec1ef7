#pragma once
/// Text of the tower's rig file, and changes of this text.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"

namespace crane::configuration {

inline const std::filesystem::path kRigs = CRANE_RIGS;
inline const std::string kTower = (kRigs / "virginia_tech_tower.toml").string();

inline std::string tower_text() {
  std::ifstream stream(kTower);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::vector<std::string> problems_of(const std::string& text) {
  try {
    (void)parse_rig(text, "rig.toml");
  } catch (const ConfigurationError& error) {
    return error.problems();
  }
  return {};
}

/// The file of the tower with the first `from` after `after` replaced by `to`. @pre `from` exists
class ChangedTower {
 public:
  ChangedTower& change(const std::string& after, const std::string& from, const std::string& to) {
    const auto start = text_.find(after);
    const auto found = start == std::string::npos ? start : text_.find(from, start);
    if (found == std::string::npos) throw std::logic_error("the rig file has no " + after + " " + from);
    text_.replace(found, from.size(), to);
    return *this;
  }
  /// "rig.toml:LINE: " of the first `key` after `after`.
  [[nodiscard]] std::string line(const std::string& after, const std::string& key) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(text_.find(key, text_.find(after)));
    return "rig.toml:" + std::to_string(1 + std::count(text_.begin(), end, '\n')) + ": ";
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_ = tower_text();
};

}  // namespace crane::configuration
