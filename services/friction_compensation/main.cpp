#include "crane/runtime/process.hpp"
#include "friction_compensation/friction_compensation.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::services::friction_compensation_spec());
}
