#include "crane/runtime/process.hpp"
#include "crane/simulator/component.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::simulator::simulated_plant_spec());
}
