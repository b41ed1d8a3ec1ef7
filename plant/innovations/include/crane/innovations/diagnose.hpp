#pragma once
/// What the simulation of a rig gets wrong, by the prediction-error method in innovations form. The result is
/// in the terms of crane::diagnosis, so that reports and scores serve both engines.
#include "crane/diagnosis/diagnosis.hpp"
#include "crane/innovations/data.hpp"

namespace crane::innovations {

/// One law that what is left goes with.
struct LeftoverLaw {
  std::string from;
  double gain_nats = 0, share = 0, force_rms = 0;
};

struct Result {
  diagnosis::Diagnosis diagnosis;
  std::vector<LeftoverLaw> leftover;
  double leftover_p_value = 1;
  double held_out_nats = 0;  ///< gain in likelihood of the extended model
  std::array<double, 2> held_out_nats_ci95{0, 0};
  std::vector<std::string> refused;  ///< rules of sanity that the best extension breaks
};

/// @param train,test whole runs belong to one side; the test runs choose nothing
/// @throws DataProblem when there is too little
[[nodiscard]] Result diagnose(const runtime::Rig& rig, std::vector<Run> train, std::vector<Run> test,
                              const diagnosis::Request& request = {});

}  // namespace crane::innovations
