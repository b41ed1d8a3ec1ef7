/// Follows a topic of a running stack: prints the trolley position once a second, for the given time in s.
///   crane up &          then          example_follow_topic 5 [--domain N --crane NAME --interface ADDRESS …]
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "crane/runtime/process.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Prints the position of the trolley once a second."};
  crane::runtime::BusOptions options;
  crane::runtime::add_bus_options(app, options);
  int seconds = 5;
  app.add_option("seconds", seconds, "how long to follow the topic")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  // A program that only reads needs no start-up number.
  crane::bus::Bus bus{crane::runtime::bus_options(options, "follow_topic", crane_SOURCE_MONITOR, 0)};
  auto states = bus.subscriber(crane::topics::state);

  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{seconds};
  int printed = 0;
  while (std::chrono::steady_clock::now() < end) {
    bus.wait(std::chrono::milliseconds{100});  // returns early when a sample arrives
    while (const auto state = states.take())
      if (state->header.tick % 100 == 0) {
        std::printf("tick %llu: trolley at %.3f m, %.3f V\n",
                    static_cast<unsigned long long>(state->header.tick), state->trolley_position_m,
                    state->applied_v[0]);
        ++printed;
      }
  }
  if (printed == 0) std::fprintf(stderr, "no crane/state arrived: is a stack running? (crane status)\n");
  return printed > 0 ? 0 : 1;
}
