#include "replay/recorded_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "crane/bus/cdr.hpp"
#include "crane/recording/run_table.hpp"

namespace crane::replay {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

bool is_input(const topics::Description& topic) {
  return topic.name == topics::request.description.name || topic.name == topics::jog.description.name;
}

bool has_channel(const recording::McapReader& reader, const topics::Description& topic) {
  return std::ranges::any_of(reader.channels(),
                             [&](const auto& channel) { return channel.topic == topic.name; });
}

recording::Metadata origin_of(recording::McapReader& reader) {
  for (auto& record : reader.metadata())
    if (record.name == "crane") return record.entries;
  return {};
}

}  // namespace

const topics::Description* topic_named(std::string_view name) {
  const auto found = std::ranges::find(topics::kAll, name, &topics::Description::name);
  return found == topics::kAll.end() ? nullptr : &*found;
}

std::optional<std::uint64_t> tick_of(std::span<const std::uint8_t> cdr) {
  const auto header = header_of(cdr);
  return header ? std::optional{header->tick} : std::nullopt;
}

RecordedRun::RecordedRun(const std::filesystem::path& file)
    : file_{file.string()}, reader_{file}, origin_{origin_of(reader_)} {
  std::vector<std::string> problems;
  const auto refuse = [&](const std::string& reason) { problems.push_back(file_ + ": " + reason); };
  const auto difference = recording::version_difference(recording::messages_version(reader_));
  if (!difference.empty()) refuse(difference);
  // The metadata of `crane run` state clock and controller; the metadata of a recorder do not.
  if (problems.empty() && !origin_.contains("clock")) arrivals_.emplace(reader_);
  if (arrivals_)
    for (const auto* topic : {&topics::accepted_request.description, &topics::accepted_jog.description})
      if (!has_channel(reader_, *topic))
        refuse(
            std::string{topic->name} +
            ": no such topic: record all topics; replay a recording of an earlier release with that release");
  const auto attachments = reader_.attachments();
  const auto rig = std::ranges::find(attachments, "rig.toml", &recording::AttachmentRecord::name);
  if (rig == attachments.end()) {
    refuse("rig.toml: no such attachment");
  } else {
    try {
      rig_text_ = {rig->data.begin(), rig->data.end()};
      rig_ = configuration::parse_rig(rig_text_, file_ + ": rig.toml");
    } catch (const configuration::ConfigurationError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  const auto stated = origin_.find("controller");
  const auto name = stated != origin_.end() ? stated->second : arrivals_ ? arrivals_->controller() : "";
  controller_ = control::find_controller(name);
  if (name.empty())
    refuse("controller: missing, neither the metadata crane nor a sample of crane/node states it");
  else if (controller_ == nullptr)
    refuse("controller = " + name + ": this program has no such controller");
  if (!problems.empty()) throw Refusal(joined(problems));
}

void RecordedRun::for_each(const std::function<bool(const RecordedTick&)>& visit) {
  if (arrivals_)
    arrivals_->for_each(std::llround(rig_.period_s * 1e9), visit);
  else
    for_each_in_order(visit);
}

void RecordedRun::for_each_in_order(const std::function<bool(const RecordedTick&)>& visit) {
  RecordedTick tick;
  std::optional<std::uint32_t> sequence;  // of the messages of `tick`
  bool goes_on = true;
  const auto finish = [&] {
    if (!tick.samples.empty()) goes_on = visit(tick);
    tick = {};
  };
  reader_.for_each({}, [&](const recording::Message& message) {
    const auto* topic = topic_named(message.channel->topic);
    if (topic == nullptr || (!topic->every_tick && !is_input(*topic))) return true;
    if (sequence && *sequence != message.sequence) finish();
    if (!goes_on) return false;
    sequence = message.sequence;
    Cdr cdr{message.data.begin(), message.data.end()};
    if (is_input(*topic)) {
      tick.inputs.push_back({topic, std::move(cdr)});
      return true;
    }
    tick.number = tick_of(message.data).value_or(message.sequence);
    if (!tick.samples.try_emplace(topic->name, std::move(cdr)).second)
      throw Refusal(file_ + ": tick " + std::to_string(tick.number) + ": two samples of " +
                    std::string{topic->name} + "; is it a merged recording?");
    return true;
  });
  if (goes_on) finish();
}

}  // namespace crane::replay
