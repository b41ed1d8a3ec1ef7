#pragma once
/// The paths of the views Runs and Diagnose: recordings of a directory, uploads, reviews and diagnoses.
#include <optional>

#include "crane/files/temporary_directory.hpp"
#include "dashboard/api_types.hpp"
#include "dashboard/jobs.hpp"
#include "dashboard/runs.hpp"

namespace crane::dashboard {

/// Files and programs that the dashboard may use.
struct RunsOptions {
  std::filesystem::path program;    ///< `crane`; empty: jobs and uploads are refused
  std::filesystem::path directory;  ///< directory of recordings; empty: none
  std::string rig;                  ///< rig file of a diagnosis; empty: unknown
};

inline constexpr std::string_view kUploadPath = "/api/uploads/";
inline constexpr std::uint64_t kLongestUpload_bytes = 16U << 20U;

class RunsApi {
 public:
  explicit RunsApi(const RunsOptions& options);

  /// @return nothing when the path does not belong to these views
  [[nodiscard]] std::optional<ApiAnswer> get(std::string_view path);
  /// @pre the visitor may operate. @throws BadRequest
  [[nodiscard]] std::optional<ApiAnswer> post(const ApiRequest& request);
  void poll() { jobs_.poll(); }

 private:
  [[nodiscard]] ApiAnswer list();
  [[nodiscard]] std::optional<ApiAnswer> job_file(std::string_view path) const;
  [[nodiscard]] ApiAnswer upload(const ApiRequest& request);
  [[nodiscard]] std::vector<Run> runs_named(const nlohmann::json& body, const char* key) const;

  std::optional<files::TemporaryDirectory> work_;
  Runs runs_;
  Jobs jobs_;
  bool starts_;  ///< true: reviews and diagnoses can be started
  std::string listed_;
  std::int64_t listed_ns_ = 0;
};

}  // namespace crane::dashboard
