#pragma once
/// First-in, first-out queue of samples of one type. A full queue grows; a queue never releases its memory.
/// In the steady state it allocates no memory.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "crane/bus/bus.hpp"

namespace crane::bus::memory {

struct Stamp {
  std::uint64_t order = 0;  ///< serial number of the publication in the network
  SampleInfo info;
  /// Version of the messages for which the delivered bytes are sealed; nothing: a wire may have changed the
  /// bytes.
  std::optional<std::uint32_t> sealed_for{};
};

class SampleQueue {
 public:
  explicit SampleQueue(std::size_t sample_bytes) : sample_bytes_{sample_bytes} {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Stamp& stamp(std::size_t i) const { return stamps_[slot(i)]; }
  [[nodiscard]] const void* sample(std::size_t i) const { return bytes_.data() + slot(i) * sample_bytes_; }

  void push(const void* sample, const Stamp& stamp) {
    if (size_ == stamps_.size()) grow();
    const std::size_t at = slot(size_++);
    stamps_[at] = stamp;
    std::memcpy(bytes_.data() + at * sample_bytes_, sample, sample_bytes_);
  }
  void pop() {
    first_ = slot(1);
    --size_;
  }
  void clear() { size_ = 0; }

 private:
  [[nodiscard]] std::size_t slot(std::size_t i) const {
    const std::size_t at = first_ + i;
    return at < stamps_.size() ? at : at - stamps_.size();
  }
  void grow() {
    SampleQueue larger{sample_bytes_};
    const std::size_t capacity = stamps_.empty() ? 4 : 2 * stamps_.size();
    larger.stamps_.resize(capacity);
    larger.bytes_.resize(capacity * sample_bytes_);
    for (std::size_t i = 0; i < size_; ++i) larger.push(sample(i), stamp(i));
    *this = std::move(larger);
  }

  std::size_t sample_bytes_;
  std::vector<Stamp> stamps_;
  std::vector<std::byte> bytes_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace crane::bus::memory
