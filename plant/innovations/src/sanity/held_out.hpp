#pragma once
/// The held-out runs, opened once: gains in windows and over whole runs, and what a name must not do there.
#include "crane/innovations/diagnose.hpp"
#include "select/search.hpp"

namespace crane::innovations {

struct HeldOutJudgement {
  diagnosis::HeldOut errors;
  double nats = 0;
  std::array<double, 2> nats_ci95{0, 0};
  std::vector<std::string> refused;
};

[[nodiscard]] HeldOutJudgement judge_held_out(const Problem& train, const Problem& test, const Model& base,
                                              const Model& extended, std::uint64_t seed);

}  // namespace crane::innovations
