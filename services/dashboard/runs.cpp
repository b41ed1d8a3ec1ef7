#include "dashboard/runs.hpp"

#include <algorithm>
#include <chrono>

#include "crane/files/complete_file.hpp"

namespace crane::dashboard {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUpload = "upload:";

std::int64_t seconds_of(fs::file_time_type time) {
  using namespace std::chrono;
  return duration_cast<seconds>(file_clock::to_sys(time).time_since_epoch()).count();
}

/// Files below `directory` whose extension is that of a run; `prefix` precedes their names.
void add_runs(std::vector<Run>& runs, const fs::path& directory, std::string_view prefix) {
  if (directory.empty()) return;
  std::error_code error;
  std::size_t visited = 0;
  auto entries =
      fs::recursive_directory_iterator{directory, fs::directory_options::skip_permission_denied, error};
  for (const fs::recursive_directory_iterator end; !error && entries != end; entries.increment(error)) {
    if (++visited > Runs::kMostVisited) return;
    if (entries.depth() >= Runs::kDeepest) entries.disable_recursion_pending();
    const auto extension = entries->path().extension();
    if (extension != ".mcap" && extension != ".csv") continue;
    std::error_code ignored;
    if (entries->is_symlink(ignored) || !entries->is_regular_file(ignored)) continue;
    const auto bytes = entries->file_size(ignored);
    const auto changed = entries->last_write_time(ignored);
    if (ignored) continue;  // the file has just been deleted
    runs.push_back(
        {.name = std::string{prefix} + entries->path().lexically_relative(directory).generic_string(),
         .file = entries->path(),
         .bytes = bytes,
         .changed_s = seconds_of(changed),
         .recording = extension == ".mcap"});
  }
}

}  // namespace

bool Run::too_large() const { return bytes > Runs::kLargest_bytes; }

std::vector<Run> Runs::list() const {
  std::vector<Run> runs;
  add_runs(runs, directory_, "");
  add_runs(runs, uploads_, kUpload);
  std::ranges::sort(runs, [](const Run& a, const Run& b) {
    return a.changed_s != b.changed_s ? a.changed_s > b.changed_s : a.name < b.name;
  });
  if (runs.size() > kMostListed) runs.resize(kMostListed);
  return runs;
}

std::optional<Run> Runs::find(std::string_view name) const {
  auto runs = list();
  const auto found = std::ranges::find(runs, name, &Run::name);
  return found == runs.end() ? std::nullopt : std::optional{std::move(*found)};
}

std::string Runs::keep(std::string_view name, std::string_view bytes) const {
  if (uploads_.empty()) return "this dashboard keeps no uploads";
  if (!is_upload_name(name))
    return "name: must be 1 to 64 letters, digits, '_', '-' and '.', and end with .csv or .mcap";
  if (bytes.empty()) return "the file is empty";
  std::vector<Run> uploads;
  add_runs(uploads, uploads_, "");
  std::erase_if(uploads,
                [&](const Run& run) { return run.name == name; });  // the new upload replaces this entry
  std::uintmax_t sum = bytes.size();
  for (const auto& run : uploads) sum += run.bytes;
  if (sum > kMostUploads_bytes || uploads.size() >= kMostUploads)
    return "the uploads take " + std::to_string(kMostUploads_bytes >> 20U) + " MB or " +
           std::to_string(kMostUploads) + " files: restart the dashboard, which deletes them";
  try {
    files::write_file(uploads_ / name, bytes);
  } catch (const files::WriteError&) {  // its text has the path of the file, which a browser need not know
    return "the file cannot be written: is the disk full?";
  }
  return "";
}

bool is_upload_name(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  const auto permitted = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= kLongest && name.front() != '.' &&
         std::ranges::all_of(name, permitted) && (name.ends_with(".csv") || name.ends_with(".mcap"));
}

}  // namespace crane::dashboard
