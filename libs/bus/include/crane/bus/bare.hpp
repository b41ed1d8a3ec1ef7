#pragma once
/// One writer and one reader directly on a DDS implementation: no checksum, no writer check, no
/// counts. `crane bench tick` measures the latency of this link: a lower bound for the latency of
/// bus::Bus.
#include <chrono>
#include <memory>

#include "crane/bus/bus.hpp"

namespace crane::bus {

class BareLink {
 public:
  BareLink(const Options& options, const topics::Description& reads, const topics::Description& writes);
  ~BareLink();
  BareLink(const BareLink&) = delete;
  BareLink& operator=(const BareLink&) = delete;

  [[nodiscard]] bool write(const void* sample);
  [[nodiscard]] bool take(void* sample);
  /// As Bus::wait().
  bool wait(std::chrono::nanoseconds timeout);
  /// True when the reader has a writer and the writer has a reader.
  [[nodiscard]] bool matched() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace crane::bus
