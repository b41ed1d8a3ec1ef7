#pragma once
/// Bounded queue between two threads. A full queue refuses and counts items, so that the producer never waits
/// for the consumer.
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace crane::dashboard {

template <class T>
class Inbox {
 public:
  /// @param capacity  largest number of waiting items, > 0
  explicit Inbox(std::size_t capacity) : capacity_{capacity} {}

  bool put(T item) {
    const std::lock_guard lock{mutex_};
    if (items_.size() >= capacity_) {
      ++refused_;
      return false;
    }
    items_.push_back(std::move(item));
    return true;
  }
  [[nodiscard]] std::vector<T> take_all() {
    const std::lock_guard lock{mutex_};
    return std::exchange(items_, {});
  }
  [[nodiscard]] std::uint64_t refused() const {
    const std::lock_guard lock{mutex_};
    return refused_;
  }

 private:
  mutable std::mutex mutex_;
  std::size_t capacity_;
  std::vector<T> items_;
  std::uint64_t refused_ = 0;
};

}  // namespace crane::dashboard
