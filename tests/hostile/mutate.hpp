#pragma once
/// Random changes of received RTPS messages that respect their structure: bits, numbers, lengths, whole
/// submessages.
#include <random>
#include <vector>

#include "rtps.hpp"

namespace crane::hostile {

using Random = std::mt19937_64;

/// Makes one to four changes. @param other  another message, for submessages of another context
[[nodiscard]] Bytes mutated(Bytes message, const Bytes& other, Random& random);

/// Selects messages: at most kMostPerKind per sequence of submessages, so that a thousand heartbeats do not
/// displace the only handshake.
class Corpus {
 public:
  static constexpr std::size_t kMostPerKind = 200;
  void add(const Bytes& message);
  [[nodiscard]] const Bytes& any(Random& random) const { return messages_[random() % messages_.size()]; }
  [[nodiscard]] std::size_t size() const { return messages_.size(); }
  [[nodiscard]] std::size_t kinds() const { return counts_.size(); }

 private:
  std::vector<Bytes> messages_;
  std::vector<std::pair<Bytes, std::size_t>>
      counts_;  ///< sequence of submessage kinds, number of occurrences
};

}  // namespace crane::hostile
