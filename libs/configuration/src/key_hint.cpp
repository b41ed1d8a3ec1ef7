#include "key_hint.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace crane::configuration {
namespace {

/// Unit suffixes of keys. Other text after the last underscore is no unit.
constexpr std::array<std::string_view, 50> kUnits{
    "m",    "mm",   "cm",   "um",     "km",     "rad",      "mrad",   "deg",   "s",    "ms",
    "us",   "ns",   "min",  "kg",     "g",      "v",        "mv",     "n",     "nm",   "hz",
    "khz",  "mps",  "mmps", "mps2",   "radps",  "radps2",   "degps",  "rpm",   "vps",  "vspm",
    "kgm2", "pm",   "ps",   "counts", "mps2pv", "radps2pv", "mpspv",  "vspr",  "degs", "volts",
    "volt", "kgps", "kgpm", "nmspr",  "vsprad", "m2",       "degps2", "ticks", "mps3", "radps3",
};

struct Split {
  std::string_view stem, unit;
};

Split split_unit(std::string_view key) {
  const auto underscore = key.rfind('_');
  if (underscore == std::string_view::npos) return {key, {}};
  const auto suffix = key.substr(underscore + 1);
  if (std::find(kUnits.begin(), kUnits.end(), suffix) == kUnits.end()) return {key, {}};
  return {key.substr(0, underscore), suffix};
}

/// Levenshtein's distance: insertions, deletions and substitutions that make one word of the other.
std::size_t edit_distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t substituted = diagonal + (from[i] == to[j] ? 0U : 1U);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

KeyHint key_hint(std::string_view unknown, const std::set<std::string, std::less<>>& known) {
  const Split given = split_unit(unknown);
  for (const auto& key : known) {
    const Split right = split_unit(key);
    if (!right.unit.empty() && right.stem == given.stem && right.unit != given.unit) {
      return {"unit must be " + std::string(right.unit) + ": " + key, key};
    }
  }
  KeyHint hint;
  std::size_t nearest = std::max<std::size_t>(2, unknown.size() / 3) + 1;
  for (const auto& key : known) {
    const std::size_t distance = edit_distance(unknown, key);
    if (distance < nearest) {
      nearest = distance;
      hint = {"unknown key; did you mean " + key + "?", key};
    }
  }
  return hint;
}

}  // namespace crane::configuration
