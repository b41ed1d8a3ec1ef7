#pragma once
/// for i in 0 ... count - 1 on all processors; results go to places of their own, so the order does not
/// matter.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace crane::diagnosis {

inline thread_local bool already_parallel = false;

template <class Work>
void parallel_for(std::size_t count, Work&& work) {
  if (already_parallel) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failing;
  const auto loop = [&] {
    already_parallel = true;
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(failing);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  const std::size_t workers = std::min<std::size_t>(count, std::max(1U, std::thread::hardware_concurrency()));
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < workers; ++i) threads.emplace_back(loop);
  loop();
  already_parallel = false;
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace crane::diagnosis
