#include "crane/runtime/process.hpp"
#include "process/simulated_plant.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::simulator::simulated_plant_spec());
}
