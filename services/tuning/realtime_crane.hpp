#pragma once
/// A crane in real time: the stack of processes with the simulated plant or the board of the rig file.
#include <filesystem>
#include <map>

#include "crane/files/directory_lock.hpp"
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
  /// @throws files::WriteError when another program uses the directory: the processes would read its rig file
  explicit RealtimeCrane(RealtimeOptions options);
  [[nodiscard]] Motion execute(const configuration::Rig& rig, const experiment::Scenario& scenario) override;
  [[nodiscard]] std::string difference_from_start(const configuration::Rig& rig) const override {
    return runs_.difference_from_start(rig);
  }

 private:
  std::filesystem::path directory_;
  files::DirectoryLock lock_;
  experiments::RealtimeRuns runs_;
};

}  // namespace crane::tuning
