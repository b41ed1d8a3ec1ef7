#include "dashboard/runs_api.hpp"

#include <charconv>

#include "crane/runtime/process.hpp"
#include "dashboard/request_text.hpp"

namespace crane::dashboard {
namespace {

using nlohmann::ordered_json;

std::filesystem::path made(const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  return directory;
}

nlohmann::json object_in(const std::string& body) {
  auto parsed = nlohmann::json::parse(body, nullptr, false);
  if (!parsed.is_object()) throw BadRequest("a JSON object is expected");
  return parsed;
}

ApiAnswer started(const Jobs::Answer& answer) {
  if (!answer.problem.empty()) return problem_answer(answer.busy ? 503 : 400, answer.problem);
  return json_answer({{"job", answer.id}});
}

}  // namespace

RunsApi::RunsApi(const RunsOptions& options)
    : work_{options.program.empty() ? std::nullopt
                                    : std::optional<files::TemporaryDirectory>{"crane_dashboard"}},
      runs_{options.directory, work_ ? made(work_->path() / "uploads") : std::filesystem::path{}},
      jobs_{options.program, options.rig, work_ ? work_->path() : std::filesystem::path{}},
      starts_{!options.program.empty()} {}

std::optional<ApiAnswer> RunsApi::get(std::string_view path) {
  if (path == "/api/runs") return list();
  if (path == "/api/jobs") return json_answer(jobs_.json());
  return job_file(path);
}

/// Reads the directory at most once a second, independent of the number of requests.
ApiAnswer RunsApi::list() {
  constexpr std::int64_t kEvery_ns = 1'000'000'000;
  const auto now_ns = runtime::monotonic_ns();
  if (listed_.empty() || now_ns - listed_ns_ > kEvery_ns) {
    ordered_json document{{"directory", runs_.directory().string()},
                          {"starts", starts_},
                          {"longest_upload_bytes", kLongestUpload_bytes},
                          {"runs", ordered_json::array()}};
    for (const auto& run : runs_.list())
      document["runs"].push_back({{"name", run.name},
                                  {"bytes", run.bytes},
                                  {"changed_s", run.changed_s},
                                  {"recording", run.recording},
                                  {"too_large", run.too_large()}});
    listed_ = json_answer(document).body;
    listed_ns_ = now_ns;
  }
  return {.body = listed_};
}

/// "/api/jobs/3/report", "/api/jobs/3/result"
std::optional<ApiAnswer> RunsApi::job_file(std::string_view path) const {
  constexpr std::string_view kJobs = "/api/jobs/";
  if (!path.starts_with(kJobs)) return std::nullopt;
  path.remove_prefix(kJobs.size());
  std::uint64_t id = 0;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), id);
  const std::string_view what{end, static_cast<std::size_t>(path.data() + path.size() - end)};
  if (error != std::errc{} || (what != "/report" && what != "/result")) return std::nullopt;
  const bool report = what == "/report";
  auto text = jobs_.file_of(id, report ? "report.html" : "result.json");
  if (!text) return problem_answer(404, "no finished job has this number");
  return ApiAnswer{.media_type = report ? "text/html; charset=utf-8" : "application/json",
                   .body = std::move(*text),
                   .report = report};
}

std::optional<ApiAnswer> RunsApi::post(const ApiRequest& request) {
  const bool upload_path = request.target.starts_with(kUploadPath);
  if (!upload_path && request.target != "/api/runs/review" && request.target != "/api/runs/diagnose" &&
      request.target != "/api/jobs/cancel")
    return std::nullopt;
  if (!starts_) return problem_answer(404, "this dashboard starts nothing");
  if (upload_path) return upload(request);
  const auto body = object_in(request.body);
  if (request.target == "/api/jobs/cancel") {
    const bool numbered = body.contains("job") && body["job"].is_number_unsigned();
    if (!numbered || !jobs_.cancel(body["job"].get<std::uint64_t>()))
      return problem_answer(404, "no job with this number waits or runs");
    return json_answer({{"cancelled", true}});
  }
  if (request.target == "/api/runs/diagnose")
    return started(jobs_.diagnose(runs_named(body, "train"), runs_named(body, "test")));
  const auto runs = runs_named(body, "run");
  return runs.empty() ? problem_answer(400, "run: the name of one run is expected")
                      : started(jobs_.review(runs.front()));
}

/// One name or a list of names; each must be in the list of runs.
std::vector<Run> RunsApi::runs_named(const nlohmann::json& body, const char* key) const {
  constexpr std::size_t kMost = 8;
  if (!body.contains(key)) return {};
  const auto names = body[key].is_array() ? body[key] : nlohmann::json::array({body[key]});
  if (names.size() > kMost) throw BadRequest(std::string{key} + ": at most 8 runs");
  std::vector<Run> runs;
  for (const auto& name : names) {
    auto run = name.is_string() ? runs_.find(name.get<std::string>()) : std::nullopt;
    if (!run) throw BadRequest(std::string{key} + ": no run of the list has this name");
    runs.push_back(std::move(*run));
  }
  return runs;
}

ApiAnswer RunsApi::upload(const ApiRequest& request) {
  const auto name = std::string_view{request.target}.substr(kUploadPath.size());
  const auto problem = runs_.keep(name, request.body);
  if (!problem.empty()) return problem_answer(400, problem);
  listed_.clear();
  return json_answer({{"run", "upload:" + std::string{name}}});
}

}  // namespace crane::dashboard
