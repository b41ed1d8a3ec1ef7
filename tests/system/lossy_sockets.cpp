/// Preloaded library that drops a share of the datagrams of a process, like a lossy link. CRANE_LOST_SHARE
/// (0.2) and CRANE_LOST_SEED set share and seed.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>

namespace {

/// The share in the file; null: no loss.
const volatile double* share() {
  static const volatile double* const mapped = [] {
    const char* path = std::getenv("CRANE_LOST_FILE");
    const int file = path == nullptr ? -1 : ::open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return static_cast<const double*>(nullptr);
    void* place = ::mmap(nullptr, sizeof(double), PROT_READ, MAP_SHARED, file, 0);
    ::close(file);
    return place == MAP_FAILED ? nullptr : static_cast<const double*>(place);
  }();
  return mapped;
}

/// splitmix64 of a counter: the decision needs no lock.
bool is_lost() {
  if (share() == nullptr || *share() <= 0) return false;
  static const std::uint64_t seed =
      (std::getenv("CRANE_LOST_SEED") ? std::strtoull(std::getenv("CRANE_LOST_SEED"), nullptr, 10) : 0) +
      static_cast<std::uint64_t>(::getpid());
  static std::atomic<std::uint64_t> count{0};
  std::uint64_t x = (seed << 32U) + 0x9E3779B97F4A7C15ULL * ++count;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  constexpr double kRange = 18446744073709551616.0;
  return static_cast<double>(x ^ (x >> 31U)) / kRange < *share();
}

bool is_datagram(int socket) {
  int type = 0;
  socklen_t size = sizeof type;
  return ::getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_DGRAM;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::size_t bytes_of(const msghdr& message) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) sum += message.msg_iov[i].iov_len;
  return sum;
}

}  // namespace

extern "C" {

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static const auto real = next<decltype(sendmsg)>("sendmsg");
  if (is_datagram(socket) && is_lost()) return static_cast<ssize_t>(bytes_of(*message));
  return real(socket, message, flags);
}

ssize_t sendto(int socket, const void* bytes, std::size_t size, int flags, const sockaddr* to,
               socklen_t length) {
  static const auto real = next<decltype(sendto)>("sendto");
  if (is_datagram(socket) && is_lost()) return static_cast<ssize_t>(size);
  return real(socket, bytes, size, flags, to, length);
}

int sendmmsg(int socket, mmsghdr* messages, unsigned count, int flags) {
  static const auto real = next<decltype(sendmmsg)>("sendmmsg");
  if (count == 0 || !is_datagram(socket)) return real(socket, messages, count, flags);
  for (unsigned i = 0; i < count; ++i) {
    if (is_lost())
      messages[i].msg_len = static_cast<unsigned>(bytes_of(messages[i].msg_hdr));
    else if (real(socket, messages + i, 1, flags) != 1)
      return i > 0 ? static_cast<int>(i) : -1;
  }
  return static_cast<int>(count);
}

}  // extern "C"
