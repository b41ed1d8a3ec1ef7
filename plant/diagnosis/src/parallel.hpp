#pragma once
/// Calls work(0) ... work(count - 1) on all processors; loops may be nested. Each iteration writes its own
/// result, so that the order of the iterations has no effect. An exception cancels the loop of its iteration
/// and is rethrown by this loop; nested loops of other iterations run to their end.
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <cstddef>

namespace crane::diagnosis {

template <class Work>
void parallel_for(std::size_t count, const Work& work) {
  tbb::task_group_context own{tbb::task_group_context::isolated};
  tbb::parallel_for(std::size_t{0}, count, work, own);
}

}  // namespace crane::diagnosis
