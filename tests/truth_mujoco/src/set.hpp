#pragma once
/// One set of a deck: a rig, its nuisances, its faults, and the recorded runs.
#include <cstdint>
#include <string>
#include <vector>

#include "fault.hpp"
#include "run.hpp"
#include "visible.hpp"

namespace mujoco_truth {

enum class SetKind { clean, single, pair, confounded, outside };
[[nodiscard]] const char* name_of(SetKind kind);

struct Deck {
  std::string name = "dev";
  std::uint64_t seed = 1;
};

struct Scored {
  Fault fault;
  double wanted = 0, size = 0;  ///< desired and reached size, in units of the nuisance (visible.hpp)
  std::vector<Column> columns;
};

struct Set {
  std::size_t number = 0;
  SetKind kind = SetKind::clean;
  Rig rig;
  Nuisance nuisance;
  double swing_reached_rad = 0;
  std::vector<Scored> faults;
  std::vector<std::string> alike;  ///< faults of the library whose effect these data hardly distinguish from
                                   ///< that of the first fault
  std::vector<Run> train, test;
};

[[nodiscard]] SetKind kind_of_set(std::size_t number);
/// The set with this number; equal on every computer. @param alike true: also searches for similar faults,
/// which takes longer
[[nodiscard]] Set made(const Deck& deck, std::size_t number, bool alike);

}  // namespace mujoco_truth
