#pragma once
/// Buses of one network in memory.
#include <gtest/gtest.h>

#include "crane/bus/bus.hpp"

namespace crane::bus {

class Memory : public ::testing::Test {
 protected:
  [[nodiscard]] Bus bus(const std::string& crane = "crane") const {
    return Bus{{.vendor = Vendor::memory,
                .crane = crane,
                .source = crane_SOURCE_PLANT,
                .epoch = 3,
                .network = network_}};
  }
  static msg::State state(std::uint64_t tick) {
    msg::State sample{};
    sample.header.tick = tick;
    sample.header.sample_time_ns = static_cast<std::int64_t>(tick) * 10'000'000;
    return sample;
  }
  static std::vector<std::uint64_t> ticks(Subscriber<msg::State>& reader) {
    std::vector<std::uint64_t> taken;
    while (const auto sample = reader.take()) taken.push_back(sample->header.tick);
    return taken;
  }

  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
};

using Ticks = std::vector<std::uint64_t>;

}  // namespace crane::bus
