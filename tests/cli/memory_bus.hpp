#pragma once
/// A bus in the memory of the test.
#include <memory>

#include "crane/bus/bus.hpp"

namespace crane::cli {

inline bus::Options options_on(const std::shared_ptr<bus::MemoryNetwork>& network, crane_Source source) {
  bus::Options options;
  options.vendor = bus::Vendor::memory;
  options.network = network;
  options.source = source;
  options.epoch = 1;
  return options;
}

inline bus::Bus bus_on(const std::shared_ptr<bus::MemoryNetwork>& network, crane_Source source) {
  return bus::Bus{options_on(network, source)};
}

}  // namespace crane::cli
