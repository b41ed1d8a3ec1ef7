#include "crane/runtime/writer_binding.hpp"

#include <algorithm>
#include <array>

#include "crane/protection.hpp"

namespace crane::runtime {
namespace {

using protection::enabled;
using enum protection::Protection;

constexpr std::array<const char*, 12> kSourceNames{
    "nobody",     "plant",    "bridge",   "planner", "tracking", "anti_swing", "friction_compensation",
    "supervisor", "operator", "recorder", "monitor", "twin"};
static_assert(kSourceNames.size() == crane_SOURCE_TWIN + 1);

std::string name_of(crane_Source source) {
  const auto number = static_cast<std::size_t>(source);
  return number < kSourceNames.size() ? kSourceNames[number] : "source " + std::to_string(number);
}

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
  if (bound_ == writer) {
    heard_ns_ = now_ns;
    return Verdict::own;
  }
  // The bound DDS writer under another name is no new start: a process keeps its source and its epoch.
  const bool renamed = bound_ && bound_->id == writer.id;
  if ((!topics::may_write(*topic_, writer.source) && enabled(bus_source)) || renamed)
    return refuse(writer, now_ns);
  if (!bound_) {
    if (matched > 1) return refuse(writer, now_ns);  // no telling which of them is the right one
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
  if (!rival_) return "a writer that has sent nothing yet";
  return "a writer that calls itself " + name_of(rival_->source) + ", start-up number " +
         std::to_string(rival_->epoch);
}

}  // namespace crane::runtime
