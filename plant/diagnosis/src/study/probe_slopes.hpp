#pragma once
/// Slopes of probes that one score test computes and later ones use again.
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "crane/diagnosis/candidate.hpp"
#include "crane/plant/parameters.hpp"
#include "study/body.hpp"

namespace crane::diagnosis {

/// Plain slopes of the probes of the base model, part by part. The base models of two score tests differ only
/// in the inaccuracies of the rig file: their slopes are nearly equal. A score test is valid for any
/// direction; a slightly different one costs little power. A hypothesis also has the slopes of the base model
/// in a part in which its effects change the simulation little (unlike(), body.hpp).
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

  /// Simulation of the base model in its last score test; empty before.
  [[nodiscard]] const Simulation& base() const { return base_; }
  void keep_base(Simulation base) { base_ = std::move(base); }

  /// Strongest shape of a candidate in the last score test of the base model. @return nullptr: unknown
  [[nodiscard]] const Shape* strongest(std::size_t candidate) const;
  void keep_strongest(std::size_t candidate, const Shape& shape);

 private:
  Simulation base_;
  std::vector<std::vector<Known>> of_candidate_;
  std::map<std::size_t, Shape> strongest_;
};

}  // namespace crane::diagnosis
