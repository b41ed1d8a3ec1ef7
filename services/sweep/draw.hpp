#pragma once
/// Parameters of the simulated crane, accessed by the keys of the rig file.
#include <string>

#include "crane/configuration/rig.hpp"
#include "crane/fields/range.hpp"

namespace crane::sweep {

struct Number {
  double* value = nullptr;  ///< nullptr: the rig has no such parameter
  fields::Range range;
};
/// Finds a number of [plant], [start] or of a model term, also when the rig file leaves it at its default.
/// @return number whose pointer is valid until the rig changes
[[nodiscard]] Number number_of(configuration::Rig& rig, const std::string& key);

/// Uniform in [0, 1), the same on every machine, independent for different seeds and indices.
[[nodiscard]] double uniform(std::uint64_t seed, std::size_t index);

}  // namespace crane::sweep
