#include "dashboard/request_queue.hpp"

#include "crane/runtime/process.hpp"

namespace crane::dashboard {

void RequestQueue::poll() {
  if (!sender_) return;
  for (auto& asked : asked_.take_all()) sender_->send(asked.wanted, std::move(asked.answered));
  sender_->poll(runtime::monotonic_ns());
}

}  // namespace crane::dashboard
