#pragma once
/// Effect of a fault on a simulation, in units of the nuisance of these data: an independent check that the
/// diagnosis of a set is possible.
///
/// In windows of 3 s of the recorded run, the model is started from the true state and driven by the commands
/// of the rows. For every column, as root mean square over all windows, with the free start of each window
/// projected out by least squares:
///   effect:   model with the fault minus model without it
///   nuisance: the recorded values of the run minus model without a fault: disturbance, friction at
///   standstill, lost commands, noise and quantisation
/// size = the largest ratio of effect to nuisance of a column.
#include <map>
#include <string>

#include "fault.hpp"
#include "run.hpp"

namespace mujoco_truth {

inline constexpr double kWindow_s = 3;

struct Column {
  std::string name;
  double nuisance = 0, effect = 0;
};

/// Windows of clean runs, prepared once for the comparison with faults of any amount.
class Visibility {
 public:
  /// @param clean runs without a fault
  Visibility(const Physics& nominal, const std::vector<Run>& clean);
  ~Visibility();
  Visibility(const Visibility&) = delete;
  Visibility& operator=(const Visibility&) = delete;

  /// Columns with both levels.
  [[nodiscard]] std::vector<Column> columns(const std::vector<Fault>& faults) const;
  [[nodiscard]] double size(const std::vector<Fault>& faults) const;
  /// Cosine between the effects of two faults, with each column in units of its nuisance.
  [[nodiscard]] double cosine(const std::vector<Fault>& a, const std::vector<Fault>& b) const;

 private:
  struct Window;
  std::vector<double> change(const Window& window, const std::vector<Fault>& faults) const;
  Physics nominal_;
  std::vector<std::string> names_;
  std::vector<double> nuisance_rms_;
  std::vector<Window> windows_;
};

}  // namespace mujoco_truth
