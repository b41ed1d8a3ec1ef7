#pragma once
/// Which hidden effects the data set of a number has. The deck is the same for everybody; a longer score
/// takes more of it.
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

/// Of twelve sets three are clean, six have one effect (at 4, 2 and 1 detection limits in turn), one each an
/// effect outside the library, two effects, and one of two confounded effects in data that hardly separate
/// them. Half the sets are of the tower. The detection limit is the amplitude at which, over windows of 2 s,
/// the effect leads a simulation as far astray as the disturbance does.
[[nodiscard]] Set set_of(std::size_t number, std::uint64_t first_seed);

/// The motion of the truth that comes nearest to one of the diagnosis' menu; empty when there is none.
[[nodiscard]] std::string run_like(const std::string& experiment);

}  // namespace crane::diagnosis::score
