#pragma once
/// The controls of the crane (docs/dashboard.md; in the code: the seat), held by one client at a
/// time. A client that takes the seat gets a secret key; all other clients may only watch. No I/O;
/// the time is an argument.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace crane::dashboard {

class OperatorSeat {
 public:
  /// A holder that is silent for this time loses the seat. The browser renews the seat every 3 s, so that two
  /// lost messages have no effect.
  static constexpr std::int64_t kHeldFor_ns = 10'000'000'000;
  static constexpr std::size_t kLongestName = 32;

  /// Takes the free seat. @param key  new secret key. @return false when another client holds the seat
  bool take(std::string_view name, std::string key, std::int64_t now_ns);
  /// Restarts kHeldFor_ns. @return true when `key` holds the seat
  bool renew(std::string_view key, std::int64_t now_ns);
  /// @return true when `key` held the seat
  bool release(std::string_view key, std::int64_t now_ns);

  /// Name of the holder; nothing: the seat is free.
  [[nodiscard]] std::optional<std::string> holder(std::int64_t now_ns) const;

 private:
  [[nodiscard]] bool holds(std::string_view key, std::int64_t now_ns) const;
  std::string name_, key_;
  std::int64_t renewed_ns_ = 0;
};

}  // namespace crane::dashboard
