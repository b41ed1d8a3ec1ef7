#pragma once
/// Slopes of probes that one score test computes and later ones use again.
#include <Eigen/Dense>
#include <cstddef>
#include <optional>
#include <vector>

#include "crane/plant/parameters.hpp"

namespace crane::diagnosis {

/// One vector per window or piece of a part of the data, for example the changes of its outputs per unit.
using PartVectors = std::vector<Eigen::VectorXd>;

/// Plain slopes of one probe: independent of the noise. Empty where the probe is not visible.
struct PlainSlope {
  PartVectors drive, equation_error, load;
};

/// Plain slopes of the probes of the base model, part by part. The base models of two score tests differ only
/// in the inaccuracies of the rig file: their slopes are nearly equal. A score test is valid for any
/// direction; a slightly different one costs little power. A hypothesis whose effects are not visible in a
/// part also has the slopes of the base model there.
class ProbeSlopes {
 public:
  struct Drive {
    PartVectors windows, equation_error;
  };
  /// Of one probe, as far as known.
  struct Known {
    plant::TermSetting probe;
    std::optional<Drive> drive;
    std::optional<PartVectors> load;
  };

  /// @return nullptr: unknown
  [[nodiscard]] const Known* find(std::size_t candidate, const plant::TermSetting& probe) const;
  /// Keeps the parts that `known` contains.
  void keep(std::size_t candidate, Known known);

 private:
  std::vector<std::vector<Known>> of_candidate_;
};

}  // namespace crane::diagnosis
