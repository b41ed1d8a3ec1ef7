#include "black_box/incident_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
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

/// Renames the file without replacing another one. Some file systems lack hard links, others lack
/// RENAME_NOREPLACE: the function tries both.
/// @return false when another file has this name
bool renamed(const std::filesystem::path& unfinished, const std::string& file) {
  if (::link(unfinished.c_str(), file.c_str()) == 0) {
    (void)::unlink(unfinished.c_str());
    return true;
  }
  if (errno != EEXIST &&
      ::renameat2(AT_FDCWD, unfinished.c_str(), AT_FDCWD, file.c_str(), RENAME_NOREPLACE) == 0)
    return true;
  if (errno == EEXIST) return false;
  throw recording::WriteError(file + ": cannot write: " + std::generic_category().message(errno));
}

std::filesystem::path published(const std::filesystem::path& unfinished, const std::filesystem::path& named) {
  std::string file = named.string() + ".mcap";
  for (int number = 2; !renamed(unfinished, file); ++number)
    file = named.string() + "_" + std::to_string(number) + ".mcap";
  return file;
}

/// True if the file is at least 10 minutes old and this host has no process with the number `pid`. A younger
/// file may belong to a process of another host or container.
bool is_abandoned(const std::filesystem::path& file, const std::string& pid) {
  constexpr std::chrono::minutes kLongestWrite{10};
  std::error_code error;
  const auto written = std::filesystem::last_write_time(file, error);
  const bool recent = error || std::filesystem::file_time_type::clock::now() - written < kLongestWrite;
  return !recent && ::kill(std::stoi(pid), 0) != 0 && errno == ESRCH;
}

/// Files of the same time are compared by name.
struct AgedFile {
  std::filesystem::file_time_type written;
  std::filesystem::path path;
  auto operator<=>(const AgedFile&) const = default;
};

}  // namespace

std::string file_name_of(const Incident& incident) {
  std::string cause = incident.first.what;
  for (char& c : cause)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return utc(incident.first.at_ns) + "_" + cause;
}

std::filesystem::path write_incident(const std::filesystem::path& directory, const Incident& incident,
                                     const Origin& origin, const recording::Metadata& processes) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);  // a failure lets the writer fail, with the reason
  const auto named = directory / file_name_of(incident);
  const std::filesystem::path unfinished = named.string() + "." + std::to_string(::getpid()) + ".part";
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
  return published(unfinished, named);
}

void keep_newest(const std::filesystem::path& directory, std::size_t files,
                 const std::filesystem::path& written) noexcept {
  static const std::regex kOurs{R"(\d{8}T\d{6}Z_\w+\.mcap)"},
      kUnfinished{R"(\d{8}T\d{6}Z_\w+\.(\d{1,9})\.part)"};
  std::error_code error;
  std::vector<AgedFile> others;
  for (const auto& entry : std::filesystem::directory_iterator{directory, error}) {
    const std::string name = entry.path().filename().string();
    std::smatch unfinished;
    if (std::regex_match(name, kOurs) && name != written.filename())
      others.push_back({std::filesystem::last_write_time(entry.path(), error), entry.path()});
    if (std::regex_match(name, unfinished, kUnfinished) && is_abandoned(entry.path(), unfinished[1]))
      std::filesystem::remove(entry.path(), error);
  }
  std::ranges::sort(others);
  if (others.empty()) return;
  const auto after_latest = others.back().written + std::chrono::microseconds{1};
  if (std::filesystem::last_write_time(written, error) < after_latest)
    std::filesystem::last_write_time(written, after_latest, error);
  const std::size_t kept = std::min(others.size(), files - std::min<std::size_t>(files, 1));
  for (const auto& file : std::span{others}.first(others.size() - kept))
    std::filesystem::remove(file.path, error);
}

}  // namespace crane::black_box
