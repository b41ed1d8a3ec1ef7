// Cost of one sample of crane/state, compared with a memcpy of the struct.
#include <benchmark/benchmark.h>

#include <cstring>

#include "crane/bus/bus.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/bus/ledger.hpp"
#include "crane/bus/seal.hpp"
#include "crc32c.hpp"

namespace {

using namespace crane;

const topics::Description& kTopic = topics::state.description;

msg::State state() {
  msg::State sample{};
  sample.header.tick = 1234;
  sample.slew_angle_rad = 0.5;
  bus::seal(kTopic, &sample, crane_SOURCE_PLANT, 1);
  return sample;
}

void memcpy_state(benchmark::State& run) {
  const auto from = state();
  msg::State to;
  while (run.KeepRunning()) {
    std::memcpy(&to, &from, sizeof to);
    benchmark::DoNotOptimize(to);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(memcpy_state);

void encode(benchmark::State& run) {
  const auto& codec = bus::CdrCodec::of(crane_CraneState_desc);
  const auto sample = state();
  std::vector<std::uint8_t> out(codec.max_encoded_bytes());
  while (run.KeepRunning()) benchmark::DoNotOptimize(codec.encode(&sample, out));
}
BENCHMARK(encode);

void decode(benchmark::State& run) {
  const auto& codec = bus::CdrCodec::of(crane_CraneState_desc);
  auto sample = state();
  std::vector<std::uint8_t> bytes(codec.max_encoded_bytes());
  bytes.resize(codec.encode(&sample, bytes));
  while (run.KeepRunning()) benchmark::DoNotOptimize(codec.decode(bytes, false, &sample));
}
BENCHMARK(decode);

template <auto Crc>
void crc(benchmark::State& run) {
  const std::vector<std::uint8_t> bytes(sizeof(msg::State), 0x5A);
  while (run.KeepRunning()) benchmark::DoNotOptimize(Crc(bytes));
}
BENCHMARK(crc<bus::crc32c>)->Name("crc32c");
BENCHMARK(crc<bus::crc32c_portable>)->Name("crc32c_boost");

void seal(benchmark::State& run) {
  auto sample = state();
  while (run.KeepRunning()) bus::seal(kTopic, &sample, crane_SOURCE_PLANT, 1);
}
BENCHMARK(seal);

void intact(benchmark::State& run) {
  const auto sample = state();
  while (run.KeepRunning()) benchmark::DoNotOptimize(bus::intact(kTopic, &sample));
}
BENCHMARK(intact);

/// Enters a sample and searches for it, as publisher and subscriber of a loop topic do.
void ledger(benchmark::State& run) {
  const auto shared = bus::Ledger::create();
  auto sample = state();
  while (run.KeepRunning()) {
    ++sample.header.tick;
    shared->enter(bus::ledger_entry(kTopic, &sample, crane_MESSAGES_VERSION));
    if (!shared->contains(bus::ledger_entry(kTopic, &sample, crane_MESSAGES_VERSION)))
      run.SkipWithError("an entered sample is missing");
  }
}
BENCHMARK(ledger)->Name("ledger_enter_and_search");

void memory_publish_and_take(benchmark::State& run) {
  bus::Bus a{{.vendor = bus::Vendor::memory, .network = bus::make_memory_network()}};
  auto writer = a.publisher(topics::state);
  std::vector<bus::Subscriber<msg::State>> readers;
  for (std::int64_t i = 0; i < run.range(0); ++i) readers.push_back(a.subscriber(topics::state));
  auto sample = state();
  while (run.KeepRunning()) {
    benchmark::DoNotOptimize(writer.publish(sample));
    for (auto& reader : readers) benchmark::DoNotOptimize(reader.take());
  }
}
BENCHMARK(memory_publish_and_take)->Arg(0)->Arg(1)->Arg(8);

}  // namespace
