#include "crane/bus/ledger.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "crane/bus/options.hpp"
#include "siphash.hpp"

namespace crane::bus {
namespace {

constexpr std::uint64_t kMagic = 0x3172656764656c63;  // "cledger1"
constexpr std::size_t kSets = 16'384;
constexpr std::size_t kWays = 7;
constexpr mode_t kOwnerOnly = S_IRUSR | S_IWUSR;

/// One cache line. A digest can be in one set only, so that a search reads one cache line. The oldest digest
/// of a set is replaced first.
struct alignas(64) DigestSet {
  std::array<std::atomic<std::uint64_t>, kWays> digests;  ///< 0: empty
  std::atomic<std::uint64_t> entered;                     ///< number of digests so far
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "processes share the atomics");
static_assert(sizeof(DigestSet) == 64);

Error refused(const std::string& name, const std::string& why) {
  return Error{"ledger " + name + ": " + why};
}

/// Replaces a standard descriptor by a higher one: a program writes its messages to descriptor 2, and a
/// message would overwrite the ledger. @return descriptor, or -1 with errno
int beyond_standard(int descriptor) {
  if (descriptor < 0 || descriptor > STDERR_FILENO) return descriptor;
  const int higher = ::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int reason = errno;
  ::close(descriptor);
  errno = reason;
  return higher;
}

}  // namespace

/// A new anonymous file contains zeros: empty sets.
struct Ledger::Page {
  std::uint64_t magic;
  SipKey key;
  std::array<DigestSet, kSets> sets;
};

std::shared_ptr<Ledger> Ledger::create() {
  const std::string name = "crane_ledger";
  const int descriptor = beyond_standard(::memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (descriptor < 0) throw refused(name, std::strerror(errno));
  const auto length = static_cast<off_t>(sizeof(Page));
  // Without a fixed size, another process could shorten the file, and an access would end this process.
  if (::fchmod(descriptor, kOwnerOnly) != 0 || ::ftruncate(descriptor, length) != 0 ||
      ::fcntl(descriptor, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    const std::string why = std::strerror(errno);
    ::close(descriptor);
    throw refused(name, why);
  }
  auto ledger = mapped(descriptor, name);
  if (::getrandom(&ledger->page_->key, sizeof(SipKey), 0) != static_cast<ssize_t>(sizeof(SipKey)))
    throw refused(name, std::strerror(errno));
  ledger->page_->magic = kMagic;
  return ledger;
}

std::shared_ptr<Ledger> Ledger::open(const std::filesystem::path& path) {
  const std::string name = path.string();
  const int descriptor = beyond_standard(::open(name.c_str(), O_RDWR | O_CLOEXEC));
  if (descriptor < 0) throw refused(name, std::strerror(errno));
  struct stat file {};
  ::fstat(descriptor, &file);
  std::string problems;
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) problems += (problems.empty() ? "" : "; ") + std::string{rule};
  };
  require(S_ISREG(file.st_mode), "must be a regular file");
  require(file.st_size == static_cast<off_t>(sizeof(Page)), "must have the size of a ledger");
  require(file.st_uid == ::geteuid(), "must belong to the user of this process");
  require((file.st_mode & (S_IRWXG | S_IRWXO)) == 0, "must be accessible to its owner only (mode 0600)");
  if (!problems.empty()) {
    ::close(descriptor);
    throw refused(name, problems);
  }
  auto ledger = mapped(descriptor, name);
  if (ledger->page_->magic != kMagic) throw refused(name, "must begin with the mark of a ledger");
  return ledger;
}

std::shared_ptr<Ledger> Ledger::mapped(int descriptor, const std::string& name) {
  void* const memory = ::mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) {
    const std::string why = std::strerror(errno);
    ::close(descriptor);
    throw refused(name, why);
  }
  return std::shared_ptr<Ledger>{new Ledger{descriptor, static_cast<Page*>(memory)}};
}

Ledger::~Ledger() {
  ::munmap(page_, sizeof(Page));
  ::close(descriptor_);
}

std::uint64_t Ledger::digest(std::span<const std::uint8_t> sample) const noexcept {
  return std::max<std::uint64_t>(siphash(page_->key, sample), 1);
}

void Ledger::enter(std::span<const std::uint8_t> sample) noexcept {
  if (sample.empty()) return;
  const auto value = digest(sample);
  auto& set = page_->sets[value % kSets];
  set.digests[set.entered.fetch_add(1) % kWays].store(value);
}

bool Ledger::contains(std::span<const std::uint8_t> sample) const noexcept {
  if (sample.empty()) return false;
  const auto value = digest(sample);
  return std::ranges::any_of(page_->sets[value % kSets].digests,
                             [value](const auto& entry) { return entry.load() == value; });
}

}  // namespace crane::bus
