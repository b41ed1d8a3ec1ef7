#include "dashboard/jobs.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "crane/runtime/process.hpp"

namespace crane::dashboard {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::uintmax_t kLargestAnswer_bytes = 16U << 20U;

const char* name_of(Jobs::State state) {
  constexpr std::array kNames{"waiting", "running", "done", "failed", "cancelled"};
  return kNames[static_cast<std::size_t>(state)];
}

/// The last lines of a program's output.
std::string tail_of(const fs::path& file) {
  constexpr std::streamoff kTail_bytes = 2000;
  std::ifstream in{file, std::ios::binary | std::ios::ate};
  if (!in) return "";
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size - kTail_bytes));
  return {std::istreambuf_iterator<char>{in}, {}};
}

struct Progress {
  double share = 0;
  std::string doing;
};
/// Progress in the last complete line "progress 0.25 TEXT" (crane diagnose --progress).
Progress progress_in(const std::string& said) {
  constexpr std::string_view kBegin = "progress ";
  const auto end = said.rfind('\n');
  if (end == std::string::npos) return {};
  const auto begin = said.rfind(kBegin, end);
  if (begin == std::string::npos) return {};
  const auto line = said.substr(begin + kBegin.size(), said.find('\n', begin) - begin - kBegin.size());
  const auto space = std::min(line.find(' '), line.size());
  const double share = std::strtod(line.substr(0, space).c_str(), nullptr);
  return {std::clamp(share, 0.0, 1.0), line.substr(std::min(space + 1, line.size()))};
}

std::vector<std::string> names_of(const std::vector<Run>& runs) {
  std::vector<std::string> names;
  names.reserve(runs.size());
  for (const auto& run : runs) names.push_back(run.name);
  return names;
}

}  // namespace

Jobs::Jobs(fs::path program, std::string rig, fs::path directory)
    : program_{std::move(program)}, rig_{std::move(rig)}, directory_{std::move(directory)} {}

Jobs::Answer Jobs::review(const Run& run) {
  if (!run.recording) return {0, run.name + ": only recordings (.mcap) can be reviewed", false};
  if (run.too_large()) return {0, run.name + ": is too large for the dashboard; use `crane review`", false};
  const auto key = run.name + '\n' + std::to_string(run.bytes) + '\n' + std::to_string(run.changed_s);
  for (const auto& job : jobs_)
    if (job.key == key && job.state != State::failed && job.state != State::cancelled)
      return {job.id, "", false};
  return add({.kind = "review",
              .key = key,
              .runs = {run.name},
              .arguments = {"review", run.file.string(), "--json", "--out"},
              .bounds = kReview});
}

Jobs::Answer Jobs::diagnose(const std::vector<Run>& train, const std::vector<Run>& test) {
  if (rig_.empty()) return {0, "the rig is unknown: start the dashboard with --rig", false};
  if (train.empty() || test.empty())
    return {0, "train and test: select at least one run of each; the test runs only confirm the result",
            false};
  for (const auto* runs : {&train, &test})
    for (const auto& run : *runs)
      if (run.too_large())
        return {0, run.name + ": is too large for the dashboard; use `crane diagnose`", false};
  Job job{.kind = "diagnose", .key = "", .runs = names_of(train), .arguments = {}, .bounds = kDiagnosis};
  for (const auto& name : names_of(test)) job.runs.push_back(name);
  job.arguments = {"diagnose", "--rig", rig_, "--train"};
  for (const auto& run : train) job.arguments.push_back(run.file.string());
  job.arguments.emplace_back("--test");
  for (const auto& run : test) job.arguments.push_back(run.file.string());
  job.arguments.insert(job.arguments.end(), {"--json", "--no-picture", "--progress", "--out"});
  return add(std::move(job));
}

Jobs::Answer Jobs::add(Job job) {
  if (std::ranges::count(jobs_, State::waiting, &Job::state) >= static_cast<std::ptrdiff_t>(kMostWaiting))
    return {0, "too many jobs wait: try again", true};
  while (jobs_.size() >= kMostKept) {
    const auto oldest = std::ranges::find_if(jobs_, [](const Job& kept) { return kept.ended_ns != 0; });
    std::error_code ignored;
    fs::remove_all(directory_of(oldest->id), ignored);
    jobs_.erase(oldest);  // always found: kMostWaiting + 1 running job < kMostKept
  }
  job.id = next_id_++;
  jobs_.push_back(std::move(job));
  poll();
  return {jobs_.back().id, "", false};
}

bool Jobs::cancel(std::uint64_t id) {
  const auto job = std::ranges::find(jobs_, id, &Job::id);
  if (job == jobs_.end() || job->ended_ns != 0) return false;
  if (running_id_ == id) {
    running_.reset();
    running_id_ = 0;
  }
  job->state = State::cancelled;
  job->ended_ns = runtime::monotonic_ns();
  poll();
  return true;
}

void Jobs::poll() {
  if (running_) {
    const auto end = running_->poll();
    if (!end) return;
    finish(*std::ranges::find(jobs_, running_id_, &Job::id), *end);
    running_.reset();
    running_id_ = 0;
  }
  const auto next = std::ranges::find(jobs_, State::waiting, &Job::state);
  if (next != jobs_.end()) start(*next);
}

void Jobs::start(Job& job) {
  const auto directory = directory_of(job.id);
  job.begun_ns = runtime::monotonic_ns();
  try {
    fs::create_directories(directory);
    auto arguments = job.arguments;
    arguments.push_back(std::string_view{job.kind} == "review" ? (directory / "report.html").string()
                                                               : directory.string());
    running_ = std::make_unique<BoundedProcess>(program_, arguments, directory / "result.json",
                                                directory / "errors.txt", job.bounds);
    running_id_ = job.id;
    job.state = State::running;
  } catch (const std::exception& error) {
    job.state = State::failed;
    job.problem = error.what();
    job.ended_ns = runtime::monotonic_ns();
  }
}

void Jobs::finish(Job& job, const BoundedProcess::End& end) {
  job.ended_ns = runtime::monotonic_ns();
  job.state = end.exit_code == 0 ? State::done : State::failed;
  if (end.exit_code == 0) return;
  const auto said = errors_of(job.id);
  job.problem = end.how + (said.empty() ? "" : ": " + said);
}

/// The output of the program without lines of progress.
std::string Jobs::errors_of(std::uint64_t id) const {
  std::string errors;
  const auto said = tail_of(directory_of(id) / "errors.txt");
  for (std::size_t at = 0; at < said.size();) {
    const auto end = std::min(said.find('\n', at), said.size());
    const auto line = said.substr(at, end - at);
    if (!line.starts_with("progress ") && !line.empty()) errors += (errors.empty() ? "" : "; ") + line;
    at = end + 1;
  }
  return errors;
}

fs::path Jobs::directory_of(std::uint64_t id) const { return directory_ / ("job_" + std::to_string(id)); }

ordered_json Jobs::json_of(const Job& job) const {
  const auto until_ns = job.ended_ns != 0 ? job.ended_ns : runtime::monotonic_ns();
  ordered_json json{
      {"id", job.id},
      {"kind", job.kind},
      {"runs", job.runs},
      {"state", name_of(job.state)},
      {"problem", job.problem},
      {"seconds", job.begun_ns == 0 ? 0.0 : static_cast<double>(until_ns - job.begun_ns) * 1e-9},
      {"longest_seconds", job.bounds.time.count()},
      {"progress", nullptr},
      {"doing", ""}};
  if (job.state != State::running) return json;
  const auto progress = progress_in(tail_of(directory_of(job.id) / "errors.txt"));
  json["progress"] = progress.share;
  json["doing"] = progress.doing;
  return json;
}

ordered_json Jobs::json() const {
  auto list = ordered_json::array();
  for (const auto& job : jobs_) list.push_back(json_of(job));
  return {{"jobs", list}};
}

std::optional<std::string> Jobs::file_of(std::uint64_t id, const char* name) const {
  const auto job = std::ranges::find(jobs_, id, &Job::id);
  if (job == jobs_.end() || job->state != State::done) return std::nullopt;
  const auto file = directory_of(id) / name;
  std::error_code error;
  if (const auto size = fs::file_size(file, error); error || size > kLargestAnswer_bytes) return std::nullopt;
  std::ifstream in{file, std::ios::binary};
  return std::string{std::istreambuf_iterator<char>{in}, {}};
}

}  // namespace crane::dashboard
