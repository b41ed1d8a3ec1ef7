#include "study/probe_slopes.hpp"

#include <algorithm>
#include <utility>

namespace crane::diagnosis {

const ProbeSlopes::Known* ProbeSlopes::find(std::size_t candidate, const plant::TermSetting& probe) const {
  if (candidate >= of_candidate_.size()) return nullptr;
  const auto found = std::ranges::find(of_candidate_[candidate], probe, &Known::probe);
  return found == of_candidate_[candidate].end() ? nullptr : &*found;
}

void ProbeSlopes::keep(std::size_t candidate, Known known) {
  if (!known.drive && !known.load) return;
  of_candidate_.resize(std::max(of_candidate_.size(), candidate + 1));
  std::vector<Known>& all = of_candidate_[candidate];
  const auto found = std::ranges::find(all, known.probe, &Known::probe);
  if (found == all.end()) {
    all.push_back(std::move(known));
    return;
  }
  if (known.drive) found->drive = std::move(known.drive);
  if (known.load) found->load = std::move(known.load);
}

const Shape* ProbeSlopes::strongest(std::size_t candidate) const {
  const auto found = strongest_.find(candidate);
  return found == strongest_.end() ? nullptr : &found->second;
}

void ProbeSlopes::keep_strongest(std::size_t candidate, const Shape& shape) {
  strongest_.insert_or_assign(candidate, shape);
}

}  // namespace crane::diagnosis
