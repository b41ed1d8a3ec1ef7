#include "crane/runtime/process.hpp"
#include "crane/supervisor/component.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::supervisor::supervisor_spec());
}
