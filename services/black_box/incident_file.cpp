#include "black_box/incident_file.hpp"

#include <algorithm>
#include <ctime>
#include <regex>
#include <vector>

namespace crane::black_box {
namespace {

std::string utc(std::int64_t time_ns) {
  const auto seconds = static_cast<std::time_t>(time_ns / 1'000'000'000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &parts);
  return text.data();
}

recording::Metadata trigger_of(const Incident& incident) {
  return {{"first_cause", incident.first.what},
          {"first_cause_explanation", incident.first.explanation},
          {"first_cause_from", incident.first.from},
          {"first_cause_remedy", incident.first.remedy},
          {"first_cause_tick", std::to_string(incident.first.tick)},
          {"first_cause_ns", std::to_string(incident.first.at_ns)},
          {"faults", std::to_string(incident.faults)}};
}

}  // namespace

std::string file_name_of(const Incident& incident) {
  std::string cause = incident.first.what;
  for (char& c : cause)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return utc(incident.first.at_ns) + "_" + cause + ".mcap";
}

std::filesystem::path write_incident(const std::filesystem::path& directory, const Incident& incident,
                                     const Origin& origin, const recording::Metadata& processes) {
  const auto file = directory / file_name_of(incident);
  const std::filesystem::path unfinished = file.string() + ".part";
  recording::McapWriter writer{unfinished, {.sync = true}};
  const auto channels = recording::add_topic_channels(writer);
  writer.metadata("crane", origin.crane);
  writer.metadata("trigger", trigger_of(incident));
  writer.metadata("processes", processes);
  for (const auto& sample : incident.samples)
    writer.message(channels[sample->topic], static_cast<std::uint32_t>(sample->header.tick),
                   sample->log_time_ns, sample->source_time_ns, sample->cdr);
  if (!origin.rig_text.empty())
    writer.attachment(
        origin.rig_name, "application/toml", incident.first.at_ns,
        std::span{reinterpret_cast<const std::uint8_t*>(origin.rig_text.data()), origin.rig_text.size()});
  writer.close();
  std::error_code error;
  std::filesystem::rename(unfinished, file, error);
  if (error) throw recording::WriteError(file.string() + ": cannot write: " + error.message());
  return file;
}

void keep_newest(const std::filesystem::path& directory, std::size_t files) noexcept {
  static const std::regex kOurs{R"(\d{8}T\d{6}Z_\w+\.mcap(\.part)?)"};
  std::error_code error;
  std::vector<std::filesystem::path> ours;
  for (const auto& entry : std::filesystem::directory_iterator{directory, error})
    if (std::regex_match(entry.path().filename().string(), kOurs)) ours.push_back(entry.path());
  if (ours.size() <= files) return;
  std::ranges::sort(ours);
  for (const auto& file : std::span{ours}.first(ours.size() - files)) std::filesystem::remove(file, error);
}

}  // namespace crane::black_box
