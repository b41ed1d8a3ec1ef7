#include "dashboard/send_queue.hpp"

#include <algorithm>

namespace crane::dashboard {

bool SendQueue::put(Outgoing message) {
  if (message.keep == Keep::may_drop && bytes_ + message.bytes() > kDropAbove_bytes) {
    ++dropped_;
    return true;
  }
  if (message.keep == Keep::newest) {
    const auto older = std::ranges::find_if(waiting_, [&](const Outgoing& waiting) {
      return waiting.keep == Keep::newest && waiting.channel == message.channel;
    });
    if (older != waiting_.end()) {
      bytes_ += message.bytes();
      bytes_ -= older->bytes();
      *older = std::move(message);
      return bytes_ <= kGiveUpAbove_bytes;
    }
  }
  bytes_ += message.bytes();
  waiting_.push_back(std::move(message));
  return bytes_ <= kGiveUpAbove_bytes;
}

Outgoing SendQueue::take() {
  Outgoing first = std::move(waiting_.front());
  waiting_.pop_front();
  bytes_ -= first.bytes();
  return first;
}

}  // namespace crane::dashboard
