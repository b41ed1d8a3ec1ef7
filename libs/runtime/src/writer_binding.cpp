#include "crane/runtime/writer_binding.hpp"

#include <algorithm>

#include "crane/protection.hpp"
#include "crane/runtime/process_name.hpp"

namespace crane::runtime {
namespace {

using protection::enabled;
using enum protection::Protection;

}  // namespace

void WriterBinding::bind(const Writer& writer, std::int64_t now_ns, std::span<const bus::WriterId> matched) {
  departed_.assign(matched.begin(), matched.end());
  std::erase(departed_, writer.id);
  bound_ = writer;
  heard_ns_ = now_ns;
}

void WriterBinding::detected(std::int64_t now_ns) {
  disputed_ns_ = now_ns;
  silence_ns_ = bound_ ? now_ns - heard_ns_ : 0;
}

WriterBinding::Verdict WriterBinding::refuse(const Writer& writer, std::int64_t now_ns) {
  ++foreign_;
  rival_ = writer;
  forged_ = false;
  detected(now_ns);
  return Verdict::foreign;
}

void WriterBinding::refuse_forged(const Writer& writer, std::int64_t now_ns) {
  (void)refuse(writer, now_ns);
  forged_ = true;
}

WriterBinding::Verdict WriterBinding::judge(const Writer& writer, std::int64_t now_ns,
                                            std::span<const bus::WriterId> matched) {
  if (is_own(writer, now_ns)) return Verdict::own;
  // A process keeps its source and epoch. A sample of the bound DDS writer with another source or epoch does
  // not come from a restarted process.
  const bool renamed = bound_ && bound_->id == writer.id;
  if ((!topics::may_write(*topic_, writer.source) && enabled(bus_source)) || renamed)
    return refuse(writer, now_ns);
  if (!bound_) {
    const bool alone = std::ranges::all_of(matched, [&](const auto& id) { return id == writer.id; });
    if (!alone) return refuse(writer, now_ns);  // the right writer cannot be determined
    bind(writer, now_ns, matched);
    return Verdict::own;
  }
  if (!silent(now_ns) && enabled(bus_one_writer)) return refuse(writer, now_ns);
  bind(writer, now_ns, matched);
  return Verdict::taken_over;
}

void WriterBinding::watch(std::int64_t now_ns, std::span<const bus::WriterId> matched) {
  if (!bound_ || silent(now_ns)) return;
  const auto contains = [](const auto& ids, const bus::WriterId& id) {
    return std::ranges::find(ids, id) != std::ranges::end(ids);
  };
  std::erase_if(departed_, [&](const auto& id) { return !contains(matched, id); });
  for (const auto& id : matched) {
    if (id == bound_->id || contains(departed_, id)) continue;
    if (!rival_ || rival_->id != id) {
      rival_ = Writer{.id = id};
      forged_ = false;
    }
    detected(now_ns);
  }
}

std::string WriterBinding::dispute(const OriginOf& origin_of) const {
  const auto named = [&](const Writer& writer) {
    const auto origin = origin_of(writer.id);
    return (writer.source == crane_SOURCE_NONE
                ? "a writer without samples"
                : std::string{process_name(writer.source)} + " " + std::to_string(writer.epoch)) +
           (origin.empty() ? "" : " (" + origin + ")");
  };
  std::string text;
  if (bound_)
    text =
        "accepted: " + named(*bound_) + ", silent for " + std::to_string(silence_ns_ / 1'000'000) + " ms; ";
  text += "refused: ";
  if (!rival_) return text + "a writer without samples";
  if (forged_) text += "a sample that no process of this stack has sent, in the name of ";
  return text + (forged_ && bound_ && *rival_ == *bound_ ? "the accepted writer" : named(*rival_));
}

}  // namespace crane::runtime
