#include "dashboard/operator_seat.hpp"

#include "dashboard/access.hpp"

namespace crane::dashboard {

bool OperatorSeat::take(std::string_view name, std::string key, std::int64_t now_ns) {
  if (holder(now_ns)) return false;
  name_ = name.substr(0, kLongestName);
  key_ = std::move(key);
  renewed_ns_ = now_ns;
  return true;
}

bool OperatorSeat::renew(std::string_view key, std::int64_t now_ns) {
  if (!holds(key, now_ns)) return false;
  renewed_ns_ = now_ns;
  return true;
}

bool OperatorSeat::release(std::string_view key, std::int64_t now_ns) {
  if (!holds(key, now_ns)) return false;
  key_.clear();
  return true;
}

std::optional<std::string> OperatorSeat::holder(std::int64_t now_ns) const {
  if (key_.empty() || now_ns - renewed_ns_ > kHeldFor_ns) return std::nullopt;
  return name_;
}

bool OperatorSeat::holds(std::string_view key, std::int64_t now_ns) const {
  return holder(now_ns) && equal_in_constant_time(key_, key);
}

}  // namespace crane::dashboard
