#include "crane/runtime/loop_process.hpp"
#include "stack/stack.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_loop_process(argc, argv, crane::stack::simulated_stack());
}
