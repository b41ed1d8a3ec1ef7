#pragma once
/// Messages that were heard, spoilt at random where RTPS has structure: bits, numbers, lengths, whole
/// submessages.
#include <random>
#include <vector>

#include "rtps.hpp"

namespace crane::hostile {

using Random = std::mt19937_64;

/// One to four changes. @param other  another message, for submessages that do not belong together
[[nodiscard]] Bytes mutated(Bytes message, const Bytes& other, Random& random);

/// Messages worth changing: at most kMostPerKind of each sequence of submessages, so that the thousand
/// heartbeats that were heard do not hide the one handshake.
class Corpus {
 public:
  static constexpr std::size_t kMostPerKind = 200;
  void add(const Bytes& message);
  [[nodiscard]] const Bytes& any(Random& random) const { return messages_[random() % messages_.size()]; }
  [[nodiscard]] std::size_t size() const { return messages_.size(); }
  [[nodiscard]] std::size_t kinds() const { return counts_.size(); }

 private:
  std::vector<Bytes> messages_;
  std::vector<std::pair<Bytes, std::size_t>> counts_;  ///< sequence of submessage kinds, how often
};

}  // namespace crane::hostile
