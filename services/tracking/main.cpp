#include "crane/runtime/process.hpp"
#include "tracking/tracking.hpp"

int main(int argc, char** argv) {
  return crane::runtime::run_process(argc, argv, crane::services::tracking_spec());
}
