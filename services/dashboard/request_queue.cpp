#include "dashboard/request_queue.hpp"

#include "crane/runtime/process.hpp"

namespace crane::dashboard {

void RequestQueue::poll() {
  if (!sender_) return;
  for (auto& queued : queue_.take_all()) sender_->send(queued.wanted, std::move(queued.answered));
  sender_->poll(runtime::monotonic_ns());
}

}  // namespace crane::dashboard
