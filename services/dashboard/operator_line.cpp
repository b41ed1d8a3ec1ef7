#include "dashboard/operator_line.hpp"

#include "crane/runtime/process.hpp"

namespace crane::dashboard {

void OperatorLine::poll() {
  if (!desk_) return;
  for (auto& asked : asked_.take_all()) desk_->send(asked.wish, std::move(asked.answered));
  desk_->poll(runtime::monotonic_ns());
}

}  // namespace crane::dashboard
