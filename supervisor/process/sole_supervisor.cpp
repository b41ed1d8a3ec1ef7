#include "process/sole_supervisor.hpp"

namespace crane::supervisor {
namespace {

/// States that follow a reset. The other states do not show whether a reset has ever been accepted.
bool follows_reset(crane_SupervisorState state) {
  switch (state) {
    case crane_STATE_READY:
    case crane_STATE_ARMING:
    case crane_STATE_HOLD:
    case crane_STATE_RUN:
    case crane_STATE_STOP_C1:
    case crane_STATE_STOP_C0:
      return true;
    default:
      return false;
  }
}

}  // namespace

SoleSupervisor::Rival& SoleSupervisor::rival_with(std::uint32_t epoch) {
  if (!rival_ || rival_->epoch != epoch) rival_ = Rival{.epoch = epoch, .vendor = {}};
  return *rival_;
}

void SoleSupervisor::heard(const msg::SupervisorStatus& status, const bus::WriterId& writer,
                           std::int64_t now_ns) {
  if (status.header.epoch == epoch_) {
    if (!own_writer_) own_writer_ = writer;
    if (writer == *own_writer_) return;
  }
  auto& rival = rival_with(status.header.epoch);
  rival.publishes = true;
  rival.established = rival.established || follows_reset(status.state);
  disputed_ns_ = now_ns;
}

void SoleSupervisor::heard(const msg::NodeStatus& status) {
  if (status.header.source != crane_SOURCE_SUPERVISOR || status.header.epoch == epoch_ ||
      status.phase == crane_PHASE_STOPPING)
    return;
  auto& rival = rival_with(status.header.epoch);
  rival.established = rival.established || status.ticks > new_ticks_;
  rival.pid = status.pid;
  rival.vendor = status.vendor;
}

void SoleSupervisor::stepped(crane_SupervisorState state) {
  ++ticks_;
  is_new_ = is_new_ && ticks_ <= new_ticks_ && !follows_reset(state);
}

std::string SoleSupervisor::rival() const {
  if (!rival_) return "";
  std::string text = "supervisor with start-up number " + std::to_string(rival_->epoch);
  if (rival_->pid != 0) text += ", process " + std::to_string(rival_->pid) + " (" + rival_->vendor + ")";
  return text;
}

}  // namespace crane::supervisor
