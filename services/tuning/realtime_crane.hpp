#pragma once
/// A crane in real time: the stack of processes with the simulated plant or the board of the rig file.
#include <filesystem>
#include <map>

#include "crane/runtime/process.hpp"
#include "experiments/realtime_run.hpp"
#include "stack/stack.hpp"
#include "tuning/crane_access.hpp"

namespace crane::tuning {

struct RealtimeOptions {
  std::filesystem::path directory;  ///< directory for the rig files of the processes
  stack::Plant plant = stack::Plant::simulated;
  runtime::BusOptions bus;
  std::map<std::string, std::string> vendors;
};

class RealtimeCrane final : public CraneAccess {
 public:
  explicit RealtimeCrane(RealtimeOptions options);
  [[nodiscard]] Motion execute(const configuration::Rig& rig, const experiment::Scenario& scenario) override;

 private:
  std::filesystem::path directory_;
  experiments::RealtimeRuns runs_;
};

}  // namespace crane::tuning
