/// In place of mujoco_case.cpp where Debian's libmujoco-dev is not installed.
#include <stdexcept>

#include "score/mujoco_case.hpp"

namespace crane::diagnosis::score {

Record scored_mujoco(std::size_t, std::uint64_t) {
  throw std::runtime_error("--deck mujoco: built without Debian's libmujoco-dev");
}
std::string kind_of_mujoco(std::size_t) { return "clean"; }

}  // namespace crane::diagnosis::score
