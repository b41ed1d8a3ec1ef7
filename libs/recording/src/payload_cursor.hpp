#pragma once
/// Reads the primitives of plain CDR in their order.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "crane/recording/schema.hpp"

namespace crane::recording {

/// Plain CDR: every primitive is aligned to its size, relative to the end of the encapsulation header.
class PayloadCursor {
 public:
  /// @param place  type or member that is read; named in errors; may change, and must outlive this object
  PayloadCursor(const std::string& place, std::span<const std::uint8_t> payload) : place_{place} {
    if (payload.size() < kEncapsulation_bytes) fail("has no encapsulation header");
    if (payload[0] != 0 || payload[1] > 1) fail("is not plain CDR");
    big_endian_ = payload[1] == 0;
    body_ = payload.subspan(kEncapsulation_bytes);
  }

  std::uint64_t raw(std::size_t bytes) {
    at_ = (at_ + bytes - 1) / bytes * bytes;
    need(bytes);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value |= std::uint64_t{body_[at_ + (big_endian_ ? bytes - 1 - i : i)]} << (8 * i);
    at_ += bytes;
    return value;
  }

  /// Content of a string, with its terminator.
  std::string_view text() {
    const auto size = raw(kTextLength_bytes);
    need(size);
    const auto bytes = body_.subspan(at_, size);
    at_ += size;
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  void finish() const {
    if (body_.size() - at_ > kMostPadding_bytes)
      fail(std::to_string(body_.size() - at_) + " bytes remain after the last field");
  }

  [[noreturn]] void fail(const std::string& what) const { throw DecodeError(place_ + ": " + what); }

 private:
  static constexpr std::size_t kEncapsulation_bytes = 4, kMostPadding_bytes = 3, kTextLength_bytes = 4;

  void need(std::size_t bytes) const {
    if (at_ > body_.size() || bytes > body_.size() - at_)
      fail("ends after " + std::to_string(body_.size()) + " of at least " + std::to_string(at_ + bytes) +
           " bytes");
  }

  const std::string& place_;
  std::span<const std::uint8_t> body_;
  std::size_t at_ = 0;
  bool big_endian_ = false;
};

}  // namespace crane::recording
