#pragma once
/// Ledger of a stack: memory that the processes of the control loop share and that programs of other
/// users cannot open.
///
/// Without keys, every program on the bus can send packets in the name of any DDS writer. Therefore each
/// process of the loop enters the digest of each sample of a loop topic in the ledger before it sends the
/// sample. Subscriber::take() returns every intact sample and states in SampleInfo::entered whether the
/// ledger contains it. runtime::LoopReader drops a sample that the ledger does not contain.
///
/// The digest is SipHash-2-4 of all fields, the topic and the version of the messages, with a random key
/// that only the ledger contains.
///
/// The ledger is an anonymous file (memfd_create) with mode 0600. `crane up` passes its descriptor to the
/// processes of the loop only. Programs of the same user can still open it, because they can also trace and
/// end these processes. The ledger connects processes of one host.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace crane::bus {

class Ledger {
 public:
  /// A new, empty ledger with a random key. @throws Error
  [[nodiscard]] static std::shared_ptr<Ledger> create();
  /// The ledger of other processes. @param path  for example "/proc/self/fd/7": an inherited descriptor
  /// @throws Error when the file is not a ledger, belongs to another user, or is accessible to other users
  [[nodiscard]] static std::shared_ptr<Ledger> open(const std::filesystem::path& path);

  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;
  ~Ledger();

  /// Descriptor of the anonymous file. Child processes inherit it only when they clear FD_CLOEXEC.
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// Enters a sample, unless it is empty. Wait-free; several processes may enter at the same time.
  void enter(std::span<const std::uint8_t> sample) noexcept;
  /// @return true when the sample was entered and is not replaced yet. The ledger holds about 110,000
  /// samples: two minutes of a loop with 100 ticks per second and eight samples per tick
  [[nodiscard]] bool contains(std::span<const std::uint8_t> sample) const noexcept;

 private:
  struct Page;  ///< the shared memory
  Ledger(int descriptor, Page* page) : descriptor_{descriptor}, page_{page} {}
  [[nodiscard]] static std::shared_ptr<Ledger> mapped(int descriptor, const std::string& name);
  [[nodiscard]] std::uint64_t digest(std::span<const std::uint8_t> sample) const noexcept;

  int descriptor_;
  Page* page_;
};

}  // namespace crane::bus
