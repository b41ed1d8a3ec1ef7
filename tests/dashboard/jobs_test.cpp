/// Jobs with a script instead of `crane`: the script prints progress and writes a result.
#include "dashboard/jobs.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "../recording/temporary_directory.hpp"
#include "child_exit.hpp"

namespace crane::dashboard {
namespace {

using recording::contents_of;
using recording::put_contents;

class JobsTest : public testing::Test {
 protected:
  JobsTest() {
    put_contents(directory_ / "run.mcap", "1");
    put_contents(directory_ / "run.csv", "1");
    std::filesystem::create_directories(directory_ / "work");
    stand_in("echo '{\"said\":\"'$*'\"}'; echo page > \"${@: -1}\"");
  }
  void stand_in(const std::string& script) {
    put_contents(directory_ / "crane", "#!/bin/bash\n" + script + "\n");
    ::chmod((directory_ / "crane").c_str(), 0700);
  }
  [[nodiscard]] dashboard::Run run(const std::string& name) const {
    return *Runs{directory_ / "", ""}.find(name);
  }
  nlohmann::json job(std::uint64_t id) {
    const nlohmann::json all = jobs_.json();
    for (const auto& one : all["jobs"])
      if (one["id"] == id) return one;
    return {};
  }
  nlohmann::json ended(std::uint64_t id) {
    for (;;) {
      jobs_.poll();
      const auto now = job(id);
      if (now["state"] != "waiting" && now["state"] != "running") return now;
      await_end_of_a_child();
    }
  }
  recording::TemporaryDirectory directory_;
  Jobs jobs_{directory_ / "crane", "rig.toml", directory_ / "work"};
};

TEST_F(JobsTest, ReviewARunOnceAndKeepItsResult) {
  const auto first = jobs_.review(run("run.mcap"));
  ASSERT_EQ(first.problem, "");
  EXPECT_EQ(ended(first.id)["state"], "done");
  EXPECT_NE(jobs_.file_of(first.id, "result.json")->find("review "), std::string::npos);
  EXPECT_EQ(*jobs_.file_of(first.id, "report.html"), "page\n");
  EXPECT_EQ(jobs_.review(run("run.mcap")).id, first.id) << "the file has not changed";
  put_contents(directory_ / "run.mcap", "22");
  EXPECT_NE(jobs_.review(run("run.mcap")).id, first.id);
}

TEST_F(JobsTest, RefuseFilesThatCannotBeReviewedOrDiagnosed) {
  EXPECT_NE(jobs_.review(run("run.csv")).problem, "");
  EXPECT_NE(jobs_.diagnose({}, {run("run.csv")}).problem, "");
  EXPECT_NE(jobs_.diagnose({run("run.csv")}, {}).problem, "");
  auto large = run("run.mcap");
  large.bytes = Runs::kLargest_bytes + 1;
  EXPECT_NE(jobs_.review(large).problem, "");
  EXPECT_NE(jobs_.diagnose({large}, {large}).problem, "");
  Jobs without_rig{directory_ / "crane", "", directory_ / "work"};
  EXPECT_NE(without_rig.diagnose({run("run.csv")}, {run("run.csv")}).problem.find("--rig"),
            std::string::npos);
}

TEST_F(JobsTest, ReportTheProgressOfADiagnosis) {
  stand_in("echo 'progress 0.25 fits friction' >&2; exec < " + (directory_ / "pipe").string() + "; read");
  ASSERT_EQ(::mkfifo((directory_ / "pipe").c_str(), 0600), 0);
  const auto started = jobs_.diagnose({run("run.csv")}, {run("run.csv")});
  ASSERT_EQ(started.problem, "");
  const std::ofstream opened{directory_ / "pipe"};  // opens when the script reads, after its progress
  jobs_.poll();
  const nlohmann::json seen = job(started.id);
  EXPECT_EQ(seen["progress"], 0.25);
  EXPECT_EQ(seen["doing"], "fits friction");
  EXPECT_EQ(seen["runs"], nlohmann::json({"run.csv", "run.csv"}));
  EXPECT_TRUE(jobs_.cancel(started.id));
  EXPECT_EQ(job(started.id)["state"], "cancelled");
  EXPECT_FALSE(jobs_.cancel(started.id));
}

TEST_F(JobsTest, ReportTheOutputOfAProgramThatFails) {
  stand_in("echo 'progress 0.5 x' >&2; echo 'run.csv:3: time_s: must rise' >&2; exit 2");
  const auto end = ended(jobs_.review(run("run.mcap")).id);
  EXPECT_EQ(end["state"], "failed");
  EXPECT_EQ(end["problem"], "exit code 2: run.csv:3: time_s: must rise");
  EXPECT_FALSE(jobs_.file_of(end["id"], "result.json"));
}

TEST_F(JobsTest, RunOneAfterTheOtherAndWaitInABoundedQueue) {
  ASSERT_EQ(::mkfifo((directory_ / "pipe").c_str(), 0600), 0);
  stand_in("read < " + (directory_ / "pipe").string());
  const auto first = jobs_.diagnose({run("run.csv")}, {run("run.csv")});
  for (std::size_t i = 0; i < Jobs::kMostWaiting; ++i)
    EXPECT_EQ(jobs_.diagnose({run("run.csv")}, {run("run.csv")}).problem, "");
  const auto refused = jobs_.diagnose({run("run.csv")}, {run("run.csv")});
  EXPECT_TRUE(refused.busy);
  std::size_t running = 0;
  const nlohmann::json all = jobs_.json();
  for (const auto& one : all["jobs"]) running += one["state"] == "running" ? 1 : 0;
  EXPECT_EQ(running, 1U);
  EXPECT_TRUE(jobs_.cancel(first.id));
  EXPECT_EQ(job(first.id + 1)["state"], "running");
}

}  // namespace
}  // namespace crane::dashboard
