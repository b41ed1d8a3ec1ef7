#pragma once
/// for i in 0 ... count - 1 on all processors, also inside another one; results go to places of their own, so
/// the order does not matter. An exception ends the loop it is thrown in and comes out of it; it does not
/// cancel loops inside other iterations, which would go on with half of their results.
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
