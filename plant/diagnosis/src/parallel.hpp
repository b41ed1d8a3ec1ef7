#pragma once
/// for i in 0 ... count - 1 on all processors, also inside another one; results go to places of their own, so
/// the order does not matter.
#include <tbb/parallel_for.h>

#include <cstddef>

namespace crane::diagnosis {

template <class Work>
void parallel_for(std::size_t count, const Work& work) {
  tbb::parallel_for(std::size_t{0}, count, work);
}

}  // namespace crane::diagnosis
