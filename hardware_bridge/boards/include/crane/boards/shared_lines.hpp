#pragma once
/// Lines between an emulated card and a rig in a separate process, in shared memory without locks. When one
/// side ends or hangs, the other side continues, and the outputs of the card keep their values, like those of
/// a real card.
#include <semaphore.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "crane/boards/emulated_servo_to_go.hpp"
#include "crane/bridge/board.hpp"

namespace crane::bridge {

/// Change of the output lines at a time of CLOCK_MONOTONIC, and the codes of the converters at that time.
struct OutputChange {
  std::atomic<std::int64_t> at_ns{0};
  std::atomic<std::uint16_t> levels{0};
  std::array<std::atomic<std::uint16_t>, kCardChannels> codes{};
};

/// Faults of the emulated card and of the wiring, for tests; one bit each.
enum CardFault : std::uint32_t {
  kStuckConverters = 1U << 0U,    ///< the converters keep their voltage whatever is written
  kStuckLatches = 1U << 1U,       ///< the output latches of the counters keep their value
  kWeldedRelay = 1U << 2U,        ///< the watchdog relay stays closed without a toggle
  kStuckBrakeOutputs = 1U << 3U,  ///< a brake output that is on stays on
};

struct SharedLines {
  std::atomic<std::uint32_t> ready{0};  ///< kReady when the rig has initialised the memory
  static constexpr std::uint32_t kReady = 0x51A6E001;
  bool lockstep = false;  ///< true: the rig advances only by advance requests

  // rig to card
  std::array<std::atomic<std::int32_t>, kCardChannels> pulses{};
  std::atomic<std::uint16_t> inputs{0xFFFF};
  std::atomic<std::int64_t> rig_time_ns{0};
  std::atomic<std::int64_t> lines_at_ns{0};  ///< time of `pulses` and `inputs`, CLOCK_MONOTONIC

  // card to rig
  CardState card;  ///< used by the process of the driver only
  std::array<std::atomic<std::uint16_t>, kCardChannels> codes{};
  std::atomic<std::uint16_t> outputs{0};
  std::atomic<std::uint32_t> changes{0};  ///< number of changes of codes and outputs
  static constexpr std::size_t kOutputChanges = 64;
  std::array<OutputChange, kOutputChanges> output_changes{};  ///< ring of the newest changes
  std::atomic<std::uint64_t> output_change_count{0};
  std::atomic<std::uint32_t> kicks{0};
  std::atomic<double> kick_radial_radps{0}, kick_tangential_radps{0};

  std::atomic<std::uint32_t> faults{0};  ///< sum of CardFault

  // Request of the card: the rig advances to `until_ns` (lockstep: rig time; real time:
  // CLOCK_MONOTONIC).
  sem_t advance{}, reached{};
  std::atomic<std::int64_t> until_ns{0};

  // times for measurements, CLOCK_MONOTONIC
  std::atomic<std::int64_t> toggled_ns{0};        ///< last change of the outputs by the card
  std::atomic<std::int64_t> relay_dropped_ns{0};  ///< opening of the relay
  std::atomic<std::int64_t> brakes_closed_ns{0};  ///< closing of the last brake
};
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

/// A named shared memory of one user (mode 0600) with one owner per role. The kernel releases a role when the
/// process of its owner ends.
class SharedFile {
 public:
  enum class Role : std::uint8_t { rig, bridge };
  /// @return true also for the file of another user
  [[nodiscard]] static bool exists(const std::string& name);
  /// Opens `name`, and creates it when it does not exist. @throws BoardError, also when the file belongs to
  /// another user
  explicit SharedFile(std::string name);
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  /// @return false when another process has this role
  [[nodiscard]] bool take(Role role);
  /// Maps `size` bytes; new memory is zero. @throws BoardError
  [[nodiscard]] void* map(std::size_t size);
  [[nodiscard]] std::size_t size() const;
  /// Removes the name; the next open creates a new file.
  void unlink() noexcept;

 private:
  std::string name_;
  int file_ = -1;
  void* memory_ = nullptr;
  std::size_t mapped_ = 0;
};

/// Waits for the semaphore; a signal does not end the wait. @return false after `duration_ns` of
/// CLOCK_MONOTONIC
[[nodiscard]] bool wait_for(sem_t& semaphore, std::int64_t duration_ns);

/// Name of the shared memory for the emulated rig of a crane.
[[nodiscard]] std::string shared_lines_name(const std::string& crane, std::uint32_t domain);

}  // namespace crane::bridge
