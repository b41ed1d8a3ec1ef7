#include "black_box/incidents.hpp"

#include <algorithm>

namespace crane::black_box {

bool is_stop(const observation::Note& note) {
  return note.kind == observation::Note::Kind::fault || observation::is_operator_stop(note);
}

void Incidents::add(const SamplePtr& sample) {
  history_.add(sample);
  traffic_.add(*sample);
  timeline_.add(*sample);
}

void Incidents::open(const observation::Fault& fault) {
  const auto stop = std::ranges::find_if(fault.notes, is_stop);
  if (stop == fault.notes.end() || fault.last_ns <= kept_until_ns_) return;
  if (fault.notes.front().at_ns > ends_ns_) return;
  const auto begin_ns = std::max(fault.notes.front().at_ns, kept_until_ns_);
  if (!open_)
    open_ = {
        .from_ns = std::max(begin_ns - kBefore_ns, started_ns_), .first = fault.notes.front(), .samples = {}};
  open_->until_ns =
      std::min(std::max(open_->until_ns, fault.last_ns + kAfter_ns), open_->from_ns + kLongest_ns);
  if (fault.number > newest_fault_) ++open_->faults;
  newest_fault_ = std::max(newest_fault_, fault.number);
  // The first cause may be detected after its consequence, for example when a process has become silent.
  if (open_->faults == 1) open_->first = fault.notes.front();
}

std::optional<Incident> Incidents::poll(std::int64_t now_ns, std::int64_t log_now_ns, bool ends) {
  const bool changed = timeline_.poll(now_ns, log_now_ns, traffic_, history_);
  if (changed)
    for (const auto& fault : timeline_.faults()) open(fault);
  if (!open_ || (!ends && log_now_ns < open_->until_ns)) return std::nullopt;
  return taken(log_now_ns);
}

Incident Incidents::taken(std::int64_t log_now_ns) {
  Incident incident = *std::move(open_);
  open_.reset();
  newest_fault_ = 0;
  incident.until_ns = kept_until_ns_ = std::min(incident.until_ns, log_now_ns);
  for (std::size_t i = 0; i < topics::kAll.size(); ++i)
    for (auto& sample : history_.between(i, incident.from_ns, incident.until_ns))
      incident.samples.push_back(std::move(sample));
  std::ranges::stable_sort(incident.samples, {}, [](const SamplePtr& sample) { return sample->log_time_ns; });
  return incident;
}

}  // namespace crane::black_box
