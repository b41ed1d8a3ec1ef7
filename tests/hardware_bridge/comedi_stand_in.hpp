#pragma once
/// Stand-in for libcomedi at link time: the functions that the driver calls, on a board with the simulated
/// crane. Forbidden calls fail the test: wrong order, an unlocked subdevice, codes beyond the range, lines
/// without a direction.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "crane/emulated_rig/wired_rig.hpp"

namespace crane::bridge::test {

using emulated_rig::WiredRig;

class ComediStandIn {
 public:
  static constexpr unsigned kAnalogOutputs = 1, kInputs = 2, kOutputs = 3, kCountersAt = 5, kSubdevices = 6;
  static constexpr unsigned kChannels = 16, kLargestCode = 8191, kGoodRange = 1;

  /// The only device while this object exists.
  explicit ComediStandIn(const configuration::Rig& rig);
  ~ComediStandIn();
  ComediStandIn(const ComediStandIn&) = delete;
  ComediStandIn& operator=(const ComediStandIn&) = delete;

  [[nodiscard]] WiredRig& rig() { return rig_; }
  /// "open", "lock 5", "volts 0 4095", "direction 3 0 1", "bits 3 15 0", "mode 2", "arm 2", "preset 2 7",
  /// "list 6"
  [[nodiscard]] const std::vector<std::string>& calls() const { return calls_; }

  // Faults that a test sets.
  bool there = true;
  unsigned locked_by_another = kSubdevices;  ///< subdevice that another program has locked; kSubdevices: none
  unsigned largest_count = 0xFFFFFF;
  double range_v = 10;  ///< limit of the suitable range
  unsigned stuck_counter = kChannels;
  bool answers = true;
  bool fixed_lines = false;  ///< true: the direction of the digital lines cannot be set

  // Implementations of the functions of libcomedi.
  void note(const std::string& call) { calls_.push_back(call); }
  void require(bool kept, const char* rule) const;
  bool open();
  void close();
  int lock(unsigned subdevice);
  void require_locked(unsigned subdevice) const;
  int configure(unsigned channel, const char* what);
  int write(unsigned subdevice, unsigned channel, unsigned range, unsigned value);
  int read(unsigned subdevice, unsigned channel, unsigned& value);
  int direct(unsigned subdevice, unsigned channel, unsigned direction);
  int bits(unsigned subdevice, unsigned mask, unsigned& value);

 private:
  WiredRig rig_;
  std::vector<std::string> calls_;
  bool open_ = false;
  std::array<bool, kSubdevices> locked_{};
  std::array<int, kChannels> counter_configured_{};
  std::array<std::uint32_t, kChannels> origin_{};
  std::array<unsigned, kSubdevices> inputs_set_{}, outputs_set_{};
  unsigned output_levels_ = 0;
};

}  // namespace crane::bridge::test
