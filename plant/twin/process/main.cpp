#include "crane/twin/component.hpp"

int main(int argc, char** argv) { return crane::runtime::run_process(argc, argv, crane::twin::twin_spec()); }
