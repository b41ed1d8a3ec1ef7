#include "sweep/sweep_run.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>

#include "crane/files/complete_file.hpp"
#include "crane/workers/process_pool.hpp"

namespace crane::sweep {
namespace {

/// Executes the remaining runs of a sweep. The process of a run sends its result; the parent logs a failure
/// for a process that ended without a result.
class Crew {
 public:
  Crew(const Sweep& sweep, const RunOptions& options, Log& log)
      : sweep_{sweep}, options_{options}, log_{log} {
    for (std::size_t i = 0; i < sweep.size(); ++i)
      if (!log.results().contains(i)) left_.push_back(i);
  }

  void work() {
    workers::run({.count = left_.size(),
                  .at_a_time = options_.processes,
                  .work =
                      [this](std::size_t i, const workers::Outbox& outbox) {
                        const Run run = run_of(sweep_, left_[i]);
                        outbox.send(result_of(run, simulate(sweep_, run)).dump());
                      },
                  .take = [this](std::size_t, const std::string& line) { add(Result::parse(line)); },
                  .ended =
                      [this](std::size_t i, const std::string& failure) {
                        if (!log_.results().contains(left_[i]))
                          add(failed(run_of(sweep_, left_[i]), failure));
                      },
                  .cancelled = options_.cancelled});
  }

 private:
  void add(const Result& result) {
    log_.add(result);
    if (!options_.progress) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    options_.progress({log_.results().size(), sweep_.size(), ++new_runs_, elapsed.count()});
  }

  const Sweep& sweep_;
  const RunOptions& options_;
  Log& log_;
  std::vector<std::size_t> left_;  ///< run numbers
  std::size_t new_runs_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

std::string to_string(const Progress& progress) {
  std::string text = std::to_string(progress.done) + " of " + std::to_string(progress.all) + " runs";
  if (progress.new_runs == 0 || progress.elapsed_s <= 0) return text;
  const double rate = static_cast<double>(progress.new_runs) / progress.elapsed_s;
  const auto left_s = std::llround(static_cast<double>(progress.all - progress.done) / rate);
  std::array<char, 96> more{};
  if (left_s < 3600)
    std::snprintf(more.data(), more.size(), ", %.1f runs/s, %lld:%02lld left", rate, left_s / 60,
                  left_s % 60);
  else
    std::snprintf(more.data(), more.size(), ", %.1f runs/s, %lld h %02lld min left", rate, left_s / 3600,
                  left_s / 60 % 60);
  return text + more.data();
}

std::vector<Group> run_sweep(const Sweep& sweep, const RunOptions& options) {
  std::filesystem::create_directories(options.directory);
  Log log{options.directory / kLogFile, sweep};
  Crew{sweep, options, log}.work();
  if (log.results().size() < sweep.size()) return {};
  auto groups = groups_of(sweep, log.results());
  files::write_file(options.directory / kRunsFile, csv_of(sweep, log.results()));
  report::write_html(options.directory / kPageFile, page_of(sweep, groups));
  return groups;
}

}  // namespace crane::sweep
