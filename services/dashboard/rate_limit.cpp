#include "dashboard/rate_limit.hpp"

namespace crane::dashboard {

bool RateLimit::permits(const Client& client, Time now) {
  forget_until(now - kRateWindow);
  const auto found = done_.find(client);
  return found == done_.end() || found->second.sum < most_;
}

void RateLimit::count(const Client& client, Time now, std::size_t amount) {
  auto& done = done_[client];
  done.sum += amount;
  done.entries.emplace_back(now, amount);
}

void RateLimit::forget_until(Time time) {
  for (auto one = done_.begin(); one != done_.end();) {
    auto& [sum, entries] = one->second;
    for (; !entries.empty() && entries.front().first <= time; entries.pop_front())
      sum -= entries.front().second;
    one = entries.empty() ? done_.erase(one) : std::next(one);
  }
}

}  // namespace crane::dashboard
