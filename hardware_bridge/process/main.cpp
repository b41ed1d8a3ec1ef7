#include "crane/bridge/component.hpp"
#include "crane/runtime/process.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::bridge::hardware_bridge_spec());
}
