#pragma once
/// The wires between an emulated card and a rig in a process of its own, as shared memory. No locks: whoever
/// dies or hangs, the other side goes on, and the card's outputs stay as they were, as a real card's do.
#include <semaphore.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "crane/boards/emulated_servo_to_go.hpp"
#include "crane/bridge/board.hpp"

namespace crane::bridge {

/// Levels of the output lines from a moment on; CLOCK_MONOTONIC.
struct OutputChange {
  std::atomic<std::int64_t> at_ns{0};
  std::atomic<std::uint16_t> levels{0};
};

struct SharedLines {
  std::atomic<std::uint32_t> ready{0};  ///< kReady when the rig has set everything up
  static constexpr std::uint32_t kReady = 0x51A6E001;
  bool lockstep = false;  ///< the rig's time runs by advance requests only

  // rig to card
  std::array<std::atomic<std::int32_t>, kCardChannels> pulses{};
  std::atomic<std::uint16_t> inputs{0xFFFF};
  std::atomic<std::int64_t> rig_time_ns{0};
  std::atomic<std::int64_t> beat_ns{0};  ///< CLOCK_MONOTONIC of the rig's last step

  // card to rig
  CardState card;  ///< the driver's process only
  std::array<std::atomic<std::uint16_t>, kCardChannels> codes{};
  std::atomic<std::uint16_t> outputs{0};
  std::atomic<std::uint32_t> changes{0};  ///< counts every change of codes and outputs
  static constexpr std::size_t kOutputChanges = 64;
  std::array<OutputChange, kOutputChanges> output_changes{};  ///< the newest ones, written round
  std::atomic<std::uint64_t> output_change_count{0};
  std::atomic<std::uint32_t> kicks{0};
  std::atomic<double> kick_radial_radps{0}, kick_tangential_radps{0};

  // lockstep
  sem_t advance{}, reached{};
  std::atomic<std::int64_t> until_ns{0};

  // what a measurement wants to know; CLOCK_MONOTONIC
  std::atomic<std::int64_t> toggled_ns{0};        ///< last change of the outputs, by the card
  std::atomic<std::int64_t> relay_dropped_ns{0};  ///< when the relay opened
  std::atomic<std::int64_t> brakes_closed_ns{0};  ///< when the last brake had closed
};
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

/// A name in shared memory with one owner at a time per role; everything falls back when its process ends,
/// however it ends.
class SharedFile {
 public:
  enum class Role : std::uint8_t { rig, bridge };
  [[nodiscard]] static bool exists(const std::string& name);
  /// Creates `name` if it is not there. @throws BoardError
  explicit SharedFile(std::string name);
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  /// @return false when another process has this role
  [[nodiscard]] bool take(Role role);
  /// Maps `size` bytes, zero where nobody has written. @throws BoardError
  [[nodiscard]] void* map(std::size_t size);
  [[nodiscard]] std::size_t size() const;
  /// The next one to open the name gets a new file.
  void unlink() noexcept;

 private:
  std::string name_;
  int file_ = -1;
  void* memory_ = nullptr;
  std::size_t mapped_ = 0;
};

/// Waits for the semaphore, through signals. @return false when `duration_ns` of CLOCK_MONOTONIC have passed
[[nodiscard]] bool wait_for(sem_t& semaphore, std::int64_t duration_ns);

/// Name of the lines of one crane's emulated rig.
[[nodiscard]] std::string shared_lines_name(const std::string& crane, std::uint32_t domain);

}  // namespace crane::bridge
