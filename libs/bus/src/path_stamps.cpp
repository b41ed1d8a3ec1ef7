#include "crane/bus/path_stamps.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <utility>

#include "crane/bus/bus.hpp"

namespace crane::bus {

/// Content of the memory file: a ring with one writer and one reader.
struct StampFile {
  static constexpr std::uint64_t kRecords = 2048;  // more than three seconds at 100 Hz with six topics
  std::atomic<std::uint64_t> written;
  std::array<PathRecord, kRecords> records;
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

namespace {

StampFile* map(int descriptor) {
  void* at = ::mmap(nullptr, sizeof(StampFile), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (at == MAP_FAILED) throw Error{std::string{"cannot map the clock stamps: "} + std::strerror(errno)};
  return static_cast<StampFile*>(at);
}

std::unique_ptr<PathStamps>& of_this_process() {
  static std::unique_ptr<PathStamps> stamps;
  return stamps;
}
PathStamps* active = nullptr;  // read by all threads; set before the first thread of a bus starts

}  // namespace

void stamp_paths_if_asked() {
  const char* file = std::getenv(kStampsVariable);
  if (file == nullptr) return;
  of_this_process() = std::make_unique<PathStamps>(file);
  active = of_this_process().get();
}
PathStamps* path_stamps() { return active; }

std::size_t index_of(std::string_view topic) {
  const auto found = std::ranges::find(topics::kAll, topic, &topics::Description::name);
  return static_cast<std::size_t>(found - topics::kAll.begin());
}

PathStamps::PathStamps(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) throw Error{file + ": cannot open the clock stamps: " + std::strerror(errno)};
  const auto size = ::lseek(descriptor, 0, SEEK_END);
  if (size != static_cast<off_t>(sizeof(StampFile))) {
    ::close(descriptor);
    throw Error{file + ": is no file of clock stamps"};
  }
  file_ = map(descriptor);
  ::close(descriptor);
}
PathStamps::~PathStamps() { ::munmap(file_, sizeof(StampFile)); }

std::int64_t PathStamps::now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

void PathStamps::arrived(std::string_view topic) { arrived_ns_.at(index_of(topic)) = now_ns(); }

void PathStamps::polled(std::int64_t time_ns) {
  next_.polled_ns = time_ns;
  next_.taking_ns = next_.checking_ns = next_.joined_ns = 0;
}

void PathStamps::took(std::int64_t begin_ns, std::int64_t taken_ns, std::int64_t checked_ns) {
  next_.taking_ns += taken_ns - begin_ns;
  next_.checking_ns += checked_ns - taken_ns;
}

void PathStamps::joined() {
  if (next_.joined_ns == 0) next_.joined_ns = now_ns();
}

void PathStamps::published(const topics::Description& topic, const msg::Header& header, std::int64_t begin_ns,
                           std::int64_t sealed_ns) {
  next_.written_ns = now_ns();
  next_.published_ns = begin_ns;
  next_.sealed_ns = sealed_ns;
  next_.topic = index_of(topic.name);
  next_.tick = header.tick;
  next_.sample_time_ns = header.sample_time_ns;
  for (std::size_t i = 0; i < arrived_ns_.size(); ++i) next_.arrived_ns[i] = arrived_ns_[i];
  const auto count = file_->written.load(std::memory_order_relaxed);
  file_->records[count % StampFile::kRecords] = next_;
  file_->written.store(count + 1, std::memory_order_release);
}

PathStampReader::PathStampReader() : descriptor_{::memfd_create("crane_clock_stamps", MFD_CLOEXEC)} {
  if (descriptor_ < 0 || ::ftruncate(descriptor_, sizeof(StampFile)) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor_ >= 0) ::close(descriptor_);
    throw Error{"cannot create a memory file for clock stamps: " + why};
  }
  file_ = map(descriptor_);
}
PathStampReader::~PathStampReader() {
  ::munmap(file_, sizeof(StampFile));
  ::close(descriptor_);
}

std::string PathStampReader::file() const {
  return "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(descriptor_);
}

void PathStampReader::take(std::vector<PathRecord>& records) {
  const auto written = file_->written.load(std::memory_order_acquire);
  if (written - taken_ > StampFile::kRecords / 2)
    throw Error{"clock stamps were overwritten before they were read"};
  for (; taken_ < written; ++taken_) records.push_back(file_->records[taken_ % StampFile::kRecords]);
}

}  // namespace crane::bus
