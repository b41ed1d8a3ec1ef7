#include "dashboard/dashboard.hpp"

int main(int argc, char** argv) { return crane::dashboard::main_of(argc, argv); }
