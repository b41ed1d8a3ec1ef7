#include "crane/runtime/process.hpp"
#include "process/hardware_bridge.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::bridge::hardware_bridge_spec());
}
