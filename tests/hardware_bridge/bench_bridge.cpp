// Cost of one cycle of the bridge on the emulated card, without the bus and without the time of the rig.
#include <benchmark/benchmark.h>

#include "crane/bridge/last_line.hpp"
#include "crane/bridge/measurement.hpp"
#include "subject.hpp"

namespace {

using namespace crane;
using namespace crane::bridge;

/// A connector without a crane, so that only card and bridge are measured.
struct StillPlug final : Connector {
  std::int32_t pulses(std::size_t /*channel*/) noexcept override { return turned; }
  std::uint16_t inputs() noexcept override { return 0; }
  void set_converter(std::size_t /*channel*/, std::uint16_t /*code*/) noexcept override {}
  void set_outputs(std::uint16_t /*levels*/) noexcept override {}
  std::int64_t now_ns() noexcept override { return 0; }
  std::int32_t turned = 0;
};

struct Cycle {
  configuration::Rig rig = test::emulated_rig();
  CardState state;
  StillPlug plug;
  ServoToGo board{rig, std::make_unique<EmulatedServoToGo>(std::uint16_t{0x200}, state, plug)};
  MeasurementPipeline measurement{rig};
  LastLine line{last_line_parameters(rig)};
};

void encoder_to_converter(benchmark::State& run) {
  Cycle c;
  std::uint64_t tick = 0;
  for (auto _ : run) {
    const auto inputs = c.board.read();
    benchmark::DoNotOptimize(c.measurement.step(inputs.raw_counts));
    Observation observation{.brake_closed = inputs.brake_closed};
    for (std::size_t i = 0; i < kCounters; ++i) {
      observation.counts[i] = c.measurement.coordinates()[i].counts();
      observation.coordinate[i] = c.measurement.coordinates()[i].position();
    }
    const CommandView command{tick, {}, {true, true, true}, true};
    ++tick;
    benchmark::DoNotOptimize(c.board.write(c.line.decide(command, tick, observation)));
  }
}
BENCHMARK(encoder_to_converter)->Unit(benchmark::kMicrosecond);

void last_line_alone(benchmark::State& run) {
  const auto rig = test::emulated_rig();
  LastLine line{last_line_parameters(rig)};
  Observation observation;
  observation.coordinate = {0.6, 0, 1, 0, 0};
  std::uint64_t tick = 0;
  for (auto _ : run) {
    const CommandView command{tick, {}, {true, true, true}, true};
    ++tick;
    benchmark::DoNotOptimize(line.decide(command, tick, observation));
  }
}
BENCHMARK(last_line_alone)->Unit(benchmark::kMicrosecond);

}  // namespace
