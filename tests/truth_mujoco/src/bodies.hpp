#pragma once
/// The tree of bodies as MuJoCo's XML.
#include <string>

#include "physics.hpp"

namespace mujoco_truth {

[[nodiscard]] std::string bodies_xml(const Physics& physics);

}  // namespace mujoco_truth
