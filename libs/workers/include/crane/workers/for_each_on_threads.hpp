#pragma once
/// Loop on several threads of the calling process.
#include <cstddef>
#include <functional>

namespace crane::workers {

/// Calls work(0) ... work(count - 1), each once, on `threads` threads; the calling thread is one of them.
/// Calls of different threads overlap in any order. After an exception, no further call begins.
/// @param threads >= 1
/// @throws an exception of work, after all calls have ended
void for_each_on_threads(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work);

}  // namespace crane::workers
