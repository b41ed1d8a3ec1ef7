#include "anti_swing/anti_swing.hpp"
#include "crane/runtime/process.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::services::anti_swing_spec());
}
