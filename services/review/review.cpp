#include "review/review.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "crane/bus/cdr.hpp"
#include "crane/fields/angle.hpp"
#include "crane/recording/schema.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::review {
namespace {

using observation::Note;
using observation::Sample;

using fields::kDegPerRad;
constexpr std::int64_t kYear2000_ns = 946'684'800'000'000'000;  // recordings of simulations begin at time 0

std::size_t topic_index(const std::string& name) {
  const auto found = std::ranges::find(topics::kAll, name, &topics::Description::name);
  return static_cast<std::size_t>(found - topics::kAll.begin());
}

/// Every sample begins with its header: little endian, without padding.
msg::Header header_of(recording::Bytes cdr) {
  msg::Header header{};
  std::uint32_t source = 0;
  const auto* at = cdr.data() + bus::kEncapsulation_bytes;
  std::memcpy(&header.tick, at, 8);
  std::memcpy(&header.sample_time_ns, at + 8, 8);
  std::memcpy(&source, at + 16, 4);
  std::memcpy(&header.epoch, at + 20, 4);
  header.source = static_cast<crane_Source>(source);
  return header;
}

/// Reads the recording sample by sample, like the observer of the dashboard.
class Reader {
 public:
  explicit Reader(Review& review) : review_{review} {}

  void add(const recording::Message& message) {
    constexpr std::size_t kLeast_bytes = 28;
    const auto topic = topic_index(message.channel->topic);
    if (topic == topics::kAll.size() || message.data.size() < kLeast_bytes) return;
    const Sample sample{.topic = topic,
                        .header = header_of(message.data),
                        .source_time_ns = message.publish_time_ns,
                        .arrival_time_ns = message.log_time_ns,
                        .written_time_ns = message.publish_time_ns,
                        .log_time_ns = message.log_time_ns,
                        .cdr = {message.data.begin(), message.data.end()}};
    poll_until(sample.log_time_ns);
    traffic_.add(sample);
    timeline_.add(sample);
    add_status(sample);
    if (msg::Reference reference; observation::decode(topics::reference, sample, reference))
      reference_ = reference;
    if (msg::State state; observation::decode(topics::state, sample, state)) add_state(sample, state);
  }

  void finish() {
    constexpr std::int64_t kLastWindow_ns = 2'000'000'000;
    traffic_.poll(review_.end_ns + kLastWindow_ns);
    review_.faults = {timeline_.faults().begin(), timeline_.faults().end()};
    for (std::size_t i = 0; i < topics::kAll.size(); ++i) review_.topics.push_back(traffic_.topic(i));
  }

 private:
  /// Polls the timeline until `now_ns`, to detect silent processes: 2.5 s for the loop, 10 s for others. Of a
  /// gap of more than a minute, for example a step of the clock, polls only the first minute, which is
  /// enough.
  void poll_until(std::int64_t now_ns) {
    constexpr std::int64_t kLongestGap_ns = 60'000'000'000;
    if (polled_ns_ == 0) polled_ns_ = now_ns;
    if (now_ns <= polled_ns_) return;
    const auto gap_ns = static_cast<std::uint64_t>(now_ns) - static_cast<std::uint64_t>(polled_ns_);
    const bool in_steps = gap_ns <= kLongestGap_ns;
    poll_for(in_steps ? now_ns - polled_ns_ : kLongestGap_ns);
    if (!in_steps) polled_ns_ = now_ns;
  }
  void poll_for(std::int64_t duration_ns) {
    constexpr std::int64_t kEvery_ns = 100'000'000;
    for (; duration_ns >= kEvery_ns; duration_ns -= kEvery_ns, polled_ns_ += kEvery_ns)
      (void)timeline_.poll(polled_ns_, polled_ns_, traffic_, history_);
  }

  void add_status(const Sample& sample) {
    msg::SupervisorStatus status;
    if (!observation::decode(topics::supervisor, sample, status)) return;
    status_ = status;
    auto& phases = review_.phases;
    if (phases.empty() || phases.back().state != status.state || phases.back().cause != status.cause)
      phases.push_back({sample.log_time_ns, sample.header.tick, status.state, status.cause});
  }

  void add_state(const Sample& sample, const msg::State& state) {
    const double time_s = static_cast<double>(sample.log_time_ns - review_.begin_ns) * 1e-9;
    auto& curves = review_.curves;
    const double period_s = curves.time_s.empty() ? 0 : time_s - curves.time_s.back();
    curves.time_s.push_back(time_s);
    const std::array position = runtime::positions(state), speed = runtime::speeds(state),
                     scale{1.0, kDegPerRad, 1.0};
    const bool armed = status_.state == crane_STATE_HOLD || status_.state == crane_STATE_RUN;
    for (std::size_t i = 0; i < 3; ++i) {
      const double wanted = reference_.header.epoch != 0 ? reference_.axis[i].position : NAN;
      curves.position[i].push_back(position[i] * scale[i]);
      curves.reference[i].push_back(armed ? wanted * scale[i] : NAN);
      curves.volts[i].push_back(state.applied_v[i]);
      auto& axis = review_.axes[i];
      axis.largest_speed = std::max(axis.largest_speed, std::abs(speed[i]) * scale[i]);
      axis.largest_volts = std::max(axis.largest_volts, std::abs(state.applied_v[i]));
      if (armed && !std::isnan(wanted))
        axis.largest_error = std::max(axis.largest_error, std::abs(wanted - position[i]) * scale[i]);
      // Share of the voltage limit above which a voltage counts as saturated; covers rounding by a 12-bit
      // converter.
      constexpr double kAtLimit = 0.999;
      if (status_.volt_limit_v[i] > 0 && std::abs(state.applied_v[i]) >= kAtLimit * status_.volt_limit_v[i])
        axis.saturated_s += period_s;
    }
    curves.radial_deg.push_back(state.swing_radial_rad * kDegPerRad);
    curves.tangential_deg.push_back(state.swing_tangential_rad * kDegPerRad);
    review_.largest_radial_deg = std::max(review_.largest_radial_deg, std::abs(curves.radial_deg.back()));
    review_.largest_tangential_deg =
        std::max(review_.largest_tangential_deg, std::abs(curves.tangential_deg.back()));
  }

  Review& review_;
  observation::Traffic traffic_;
  observation::History history_;  ///< remains empty, because the file itself is the history
  observation::FaultTimeline timeline_;
  msg::Reference reference_{};
  msg::SupervisorStatus status_{};
  std::int64_t polled_ns_ = 0;
};

void require_this_version(const recording::McapReader& reader, const std::filesystem::path& file) {
  for (const auto& channel : reader.channels()) {
    if (topic_index(channel.topic) == topics::kAll.size()) continue;
    const auto* schema = reader.find_schema(channel.schema_id);
    if (schema == nullptr || !recording::define_equal_types(schema->text, topics::idl_text()))
      throw recording::ReadError(
          file.string() + ": " + channel.topic +
          " has the message types of another version: review it with the `crane` of that "
          "version, or export it (crane log export csv)");
  }
}

}  // namespace

const observation::Fault* Review::first_stop() const {
  const auto* cause = first_cause();
  const auto contains = [cause](const observation::Fault& fault) {
    return std::ranges::any_of(fault.notes, [cause](const Note& note) { return &note == cause; });
  };
  const auto found = std::ranges::find_if(faults, contains);
  return found == faults.end() ? nullptr : &*found;
}

const Note* Review::first_cause() const {
  using Rule = bool (*)(const Review&, const Note&);
  constexpr Rule kRules[]{
      [](const Review& r, const Note& n) {
        return r.trigger && n.what == r.trigger->what && n.at_ns == r.trigger->at_ns;
      },
      [](const Review& r, const Note& n) { return r.trigger && n.what == r.trigger->what && !n.earlier; },
      [](const Review&, const Note& n) { return n.kind == Note::Kind::fault && !n.earlier; },
      [](const Review&, const Note& n) { return observation::is_operator_stop(n) && !n.earlier; },
      [](const Review&, const Note& n) { return n.kind == Note::Kind::order && !n.earlier; },
      [](const Review&, const Note& n) { return n.kind != Note::Kind::warning; }};
  for (const auto rule : kRules)
    for (const auto& fault : faults)  // in the order of time
      for (const auto& note : fault.notes)
        if (rule(*this, note)) return &note;
  return nullptr;
}

/// @return trigger in the metadata of a black-box recording; nothing for any other recording
std::optional<Note> trigger_of(recording::McapReader& reader) {
  const auto records = reader.metadata();
  const auto record = std::ranges::find(records, "trigger", &recording::MetadataRecord::name);
  if (record == records.end()) return std::nullopt;
  const auto value = [&](const char* key) {
    const auto found = record->entries.find(key);
    return found == record->entries.end() ? std::string{} : found->second;
  };
  return Note{.at_ns = std::strtoll(value("first_cause_ns").c_str(), nullptr, 10),
              .tick = std::strtoull(value("first_cause_tick").c_str(), nullptr, 10),
              .from = value("first_cause_from"),
              .what = value("first_cause"),
              .explanation = value("first_cause_explanation"),
              .remedy = value("first_cause_remedy")};
}

/// Adds a trigger that no sample contains, for example the end of `crane up`.
void add_trigger(Review& review) {
  const auto& trigger = *review.trigger;
  for (const auto& fault : review.faults)
    if (std::ranges::find(fault.notes, trigger.what, &Note::what) != fault.notes.end()) return;
  const auto later = std::ranges::upper_bound(review.faults, trigger.at_ns, {}, &observation::Fault::last_ns);
  review.faults.insert(later, {.number = review.faults.size() + 1,
                               .notes = {trigger},
                               .last_ns = trigger.at_ns,
                               .surrounding_samples = {}});
}

Review review(const std::filesystem::path& file) {
  recording::McapReader reader{file};
  require_this_version(reader, file);
  Review result;
  result.file = file.string();
  result.begin_ns = reader.first_time_ns();
  result.end_ns = reader.last_time_ns();
  result.wall_clock = result.begin_ns > kYear2000_ns;
  result.trigger = trigger_of(reader);
  Reader samples{result};
  reader.for_each({}, [&samples](const recording::Message& message) {
    samples.add(message);
    return true;
  });
  samples.finish();
  if (result.trigger) add_trigger(result);
  result.problems = reader.problems();
  return result;
}

}  // namespace crane::review
