#pragma once
/// Slopes of probes that one score test computes and later ones use again.
#include <Eigen/Dense>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
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
/// direction; a slightly different one costs little power. A hypothesis also has the slopes of the base model
/// in a part in which its effects change the simulation little (Study::unlike_base).
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

  /// Strongest shape of a candidate in the last score test of the base model. @return nullptr: unknown
  [[nodiscard]] const Shape* strongest(std::size_t candidate) const;
  void keep_strongest(std::size_t candidate, const Shape& shape);

 private:
  std::vector<std::vector<Known>> of_candidate_;
  std::map<std::size_t, Shape> strongest_;
};

}  // namespace crane::diagnosis
