#include "crane/runtime/process.hpp"
#include "trajectory_planner/trajectory_planner.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::services::trajectory_planner_spec());
}
