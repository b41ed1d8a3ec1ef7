#pragma once
/// The deck: hidden effects of each numbered data set. A longer score uses more sets.
#include <cstdint>
#include <string>

#include "truth/truth.hpp"

namespace crane::diagnosis::score {

enum class Kind { clean, single, outside, pair, confounded };
[[nodiscard]] const char* name_of(Kind kind);

struct Set {
  std::size_t number = 0;
  Kind kind = Kind::clean;
  double multiple = 0;  ///< amplitude in detection limits: 4, 2, 1; 0: none, or below all of them
  truth::Case request;
};

/// Of twelve sets, three are clean and six have one effect (at 4, 2 and 1 detection limits in turn). One set
/// has an effect outside the library, one set has two effects, and one set has one of two confounded effects
/// in data that hardly separate them. Half the sets are of the tower. The detection limit is the amplitude at
/// which, over windows of 2 s, the effect changes the simulation as much as the disturbance does.
[[nodiscard]] Set set_of(std::size_t number, std::uint64_t first_seed);

/// Motion of the truth that resembles a motion of the menu of the diagnosis; empty: none.
[[nodiscard]] std::string run_like(const std::string& experiment);

}  // namespace crane::diagnosis::score
