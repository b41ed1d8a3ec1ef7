#pragma once
/// The hidden effects: nominal sizes, what they change in the crane, what the answer says about them.
#include "random.hpp"
#include "truth/physics.hpp"
#include "truth/truth.hpp"

namespace truth {

/// Changes `physics` and says how. @throws std::invalid_argument
Found apply(const Hidden& hidden, Physics& physics, std::uint64_t seed);

}  // namespace truth
