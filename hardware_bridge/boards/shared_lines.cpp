#include "crane/boards/shared_lines.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "crane/runtime/process.hpp"

namespace crane::bridge {

namespace {

BoardError refused(const std::string& name, const std::string& why) {
  return BoardError{"shared memory " + name + ": " + why};
}
BoardError of_another_user(const std::string& name) {
  return refused(name, "belongs to another user: end the program of this user and remove /dev/shm" + name +
                           ", or choose another --crane");
}

}  // namespace

bool SharedFile::exists(const std::string& name) {
  const int file = ::shm_open(name.c_str(), O_RDONLY, 0);
  if (file >= 0) ::close(file);
  return file >= 0 || errno != ENOENT;
}

SharedFile::SharedFile(std::string name) : name_{std::move(name)} {
  constexpr mode_t kOwnerOnly = S_IRUSR | S_IWUSR;
  file_ = ::shm_open(name_.c_str(), O_RDWR | O_CREAT, kOwnerOnly);
  if (file_ < 0) throw errno == EACCES ? of_another_user(name_) : refused(name_, std::strerror(errno));
  struct stat status {};
  // The owner of a file can change it at any time. A file of an earlier version has another mode.
  if (::fstat(file_, &status) == 0 && status.st_uid == ::geteuid() && ::fchmod(file_, kOwnerOnly) == 0)
    return;
  ::close(file_);
  throw of_another_user(name_);
}

SharedFile::~SharedFile() {
  if (memory_ != nullptr) ::munmap(memory_, mapped_);
  ::close(file_);
}

bool SharedFile::take(Role role) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(role);
  lock.l_len = 1;
  return ::fcntl(file_, F_OFD_SETLK, &lock) == 0;
}

std::size_t SharedFile::size() const {
  struct stat status {};
  return ::fstat(file_, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

void* SharedFile::map(std::size_t wanted) {
  // Allocates the memory now: an access to memory that is not available ends the process with SIGBUS.
  if (const int error = ::posix_fallocate(file_, 0, static_cast<off_t>(wanted)); error != 0)
    throw refused(name_, std::strerror(error));
  void* memory = ::mmap(nullptr, wanted, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory == MAP_FAILED) throw refused(name_, std::strerror(errno));
  memory_ = memory;
  mapped_ = wanted;
  return memory_;
}

void SharedFile::unlink() noexcept { ::shm_unlink(name_.c_str()); }

std::string shared_lines_name(const std::string& crane, std::uint32_t domain) {
  return "/crane_rig_" + std::to_string(domain) + "_" + crane;
}

bool wait_for(sem_t& semaphore, std::int64_t duration_ns) {
  const auto at_ns = runtime::monotonic_ns() + duration_ns;
  const timespec at{.tv_sec = at_ns / 1'000'000'000, .tv_nsec = at_ns % 1'000'000'000};
  int result = 0;
  do result = ::sem_clockwait(&semaphore, CLOCK_MONOTONIC, &at);
  while (result != 0 &&
         errno == EINTR);  // a signal must not interrupt a tick; the loop checks for a stop request
  return result == 0;
}

}  // namespace crane::bridge
