#pragma once
/// Slopes: changes of the outputs of a simulation per unit of a value.
#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "study/hypothesis.hpp"

namespace crane::diagnosis {

/// One vector per window or piece of a part of the data, for example the changes of its outputs per unit.
using PartVectors = std::vector<Eigen::VectorXd>;

/// Slopes along one value, not whitened: independent of the noise. Empty where the value is not visible.
struct PlainSlope {
  PartVectors drive, equation_error, load;
};

/// Slopes along several values, whitened or plain, by value and by window or piece. Empty where a value is
/// not visible or its slope is not known.
struct Slopes {
  std::vector<PartVectors> drive, equation_error, load;

  [[nodiscard]] std::size_t size() const { return drive.size(); }
  void push_back(PlainSlope slope) {
    drive.push_back(std::move(slope.drive));
    equation_error.push_back(std::move(slope.equation_error));
    load.push_back(std::move(slope.load));
  }
  [[nodiscard]] PlainSlope of_value(std::size_t i) const { return {drive[i], equation_error[i], load[i]}; }
  /// Appends the slopes of `more`.
  void append(Slopes more) {
    for (std::size_t i = 0; i < more.size(); ++i)
      push_back({std::move(more.drive[i]), std::move(more.equation_error[i]), std::move(more.load[i])});
  }
  /// Empties the slopes of the values from `first` to the one before `end`, in these parts.
  void forget(std::size_t first, std::size_t end, ShowsIn parts) {
    for (std::size_t i = first; i < std::min(end, size()); ++i) {
      if (parts.drive) drive[i].clear(), equation_error[i].clear();
      if (parts.load) load[i].clear();
    }
  }
  /// Drops the slopes of all but the first values.
  void keep_first(std::size_t values) {
    for (auto* of : {&drive, &equation_error, &load}) of->resize(std::min(of->size(), values));
  }
};

}  // namespace crane::diagnosis
