#include "crane/runtime/writer_binding.hpp"

#include <algorithm>

#include "crane/protection.hpp"
#include "crane/runtime/process_name.hpp"

namespace crane::runtime {
namespace {

using protection::enabled;
using enum protection::Protection;

}  // namespace

void WriterBinding::bind(const Writer& writer, std::int64_t now_ns, int matched) {
  departed_ = std::max(matched - 1, 0);
  bound_ = writer;
  heard_ns_ = now_ns;
}

WriterBinding::Verdict WriterBinding::refuse(const Writer& writer, std::int64_t now_ns) {
  ++foreign_;
  rival_ = writer;
  disputed_ns_ = now_ns;
  return Verdict::foreign;
}

WriterBinding::Verdict WriterBinding::judge(const Writer& writer, std::int64_t now_ns, int matched) {
  if (is_own(writer, now_ns)) return Verdict::own;
  // A process keeps its source and epoch. A sample of the bound DDS writer with another source or epoch does
  // not come from a restarted process.
  const bool renamed = bound_ && bound_->id == writer.id;
  if ((!topics::may_write(*topic_, writer.source) && enabled(bus_source)) || renamed)
    return refuse(writer, now_ns);
  if (!bound_) {
    if (matched > 1) return refuse(writer, now_ns);  // the right writer cannot be determined
    bind(writer, now_ns, matched);
    return Verdict::own;
  }
  if (!silent(now_ns) && enabled(bus_one_writer)) return refuse(writer, now_ns);
  bind(writer, now_ns, matched);
  return Verdict::taken_over;
}

void WriterBinding::watch(std::int64_t now_ns, int matched) {
  if (!bound_ || silent(now_ns)) return;
  departed_ = std::min(departed_, std::max(matched - 1, 0));
  if (matched > 1 + departed_) disputed_ns_ = now_ns;
}

std::string WriterBinding::rival() const {
  if (!rival_) return "a writer that has sent no sample yet";
  return std::string{"a writer that calls itself "} + process_name(rival_->source) + ", start-up number " +
         std::to_string(rival_->epoch);
}

}  // namespace crane::runtime
