#pragma once
/// The hidden effects: nominal sizes, changes of the crane, entries of the answer.
#include "random.hpp"
#include "truth/physics.hpp"
#include "truth/truth.hpp"

namespace truth {

/// Changes `physics`. @return the description of the change. @throws std::invalid_argument
Found apply(const Hidden& hidden, Physics& physics, std::uint64_t seed);

}  // namespace truth
