#include "search/selection.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace crane::diagnosis {

std::vector<const Candidate*> alike(const Candidate& candidate, const std::vector<Candidate>& candidates,
                                    const std::vector<Visibility>& excitation) {
  std::vector<std::string> labels;
  for (const Visibility& effect : excitation)
    if (effect.cause == candidate.cause && effect.axis == candidate.axis)
      for (const Visibility::Alike& other : effect.alike) labels.push_back(other.label);
  std::vector<const Candidate*> found;
  for (const Visibility& effect : excitation)
    if (std::ranges::find(labels, effect.label) != labels.end())
      for (const Candidate& other : candidates)
        if (other.cause == effect.cause && other.axis == effect.axis) found.push_back(&other);
  return found;
}

std::vector<Score> strongest(std::vector<Score> left, std::size_t count, std::vector<Score> always) {
  std::vector<Score> order = std::move(always);
  const std::size_t first = order.size();
  const auto take = [&](std::size_t up_to, auto&& before) {
    std::sort(left.begin(), left.end(), before);
    const std::size_t taken = std::min(up_to - order.size(), left.size());
    const auto end = left.begin() + static_cast<std::ptrdiff_t>(taken);
    order.insert(order.end(), left.begin(), end);
    left.erase(left.begin(), end);
  };
  take(first + (count + 1) / 2, [](const Score& a, const Score& b) { return a.share > b.share; });
  take(first + count, [](const Score& a, const Score& b) { return a.p_value < b.p_value; });
  return order;
}

}  // namespace crane::diagnosis
