#pragma once
/// One operator at a time: who takes the seat gets a key, and the others watch. Pure; time is an argument.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace crane::dashboard {

class OperatorSeat {
 public:
  /// A holder who is silent for so long has lost the seat: his browser renews every 3 s, so that two messages
  /// may be lost.
  static constexpr std::int64_t kHeldFor_ns = 10'000'000'000;
  static constexpr std::size_t kLongestName = 32;

  /// Takes the free seat. @param key  new key, which no one else knows. @return false when another one holds
  /// it
  bool take(std::string_view name, std::string key, std::int64_t now_ns);
  /// @return true when `key` holds the seat; the time then begins anew
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
