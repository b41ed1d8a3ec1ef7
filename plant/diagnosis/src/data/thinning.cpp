#include "data/thinning.hpp"

#include <algorithm>

namespace crane::diagnosis {
namespace {

constexpr double kFinest_s = 0.01;

std::vector<double> every(const std::vector<double>& values, std::size_t step) {
  std::vector<double> kept;
  for (std::size_t k = 0; k < values.size(); k += step) kept.push_back(values[k]);
  return kept;
}

void thin(Run& run, std::size_t step) {
  std::vector<plant::PerAxis> command_v;
  for (std::size_t k = 0; k < run.rows(); k += step) {
    const std::size_t end = std::min(k + step, run.rows());
    plant::PerAxis mean{};
    for (std::size_t i = k; i < end; ++i)
      for (std::size_t axis = 0; axis < mean.size(); ++axis)
        mean[axis] += run.command_v[i][axis] / static_cast<double>(end - k);
    command_v.push_back(mean);
  }
  run.command_v = std::move(command_v);
  for (auto& measured : run.measured) measured = every(measured, step);
  run.cable_m = every(run.cable_m, step);
  run.period_s *= static_cast<double>(step);
}

}  // namespace

Loaded thinned(Loaded loaded) {
  for (Run& run : loaded.runs) {
    const auto step = static_cast<std::size_t>(kFinest_s / run.period_s + 1e-6);
    if (step < 2) continue;
    loaded.notes.push_back(run.name + ": one row in " + std::to_string(step) +
                           " is used: nothing of a crane moves faster than 100 samples a second show");
    thin(run, step);
  }
  return loaded;
}

}  // namespace crane::diagnosis
