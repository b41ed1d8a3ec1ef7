#include "key_hint.hpp"

#include <algorithm>
#include <array>

#include "crane/fields/nearest_name.hpp"

namespace crane::configuration {
namespace {

/// Unit suffixes of keys. Other text after the last underscore is not a unit.
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

}  // namespace

KeyHint key_hint(std::string_view unknown, const std::set<std::string, std::less<>>& known) {
  const Split given = split_unit(unknown);
  for (const auto& key : known) {
    const Split right = split_unit(key);
    if (!right.unit.empty() && right.stem == given.stem && right.unit != given.unit) {
      return {"unit must be " + std::string(right.unit) + ": " + key, key};
    }
  }
  const std::string meant = fields::nearest_name(unknown, known);
  return meant.empty() ? KeyHint{} : KeyHint{"unknown key; did you mean " + meant + "?", meant};
}

}  // namespace crane::configuration
