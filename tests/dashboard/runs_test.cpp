#include "dashboard/runs.hpp"

#include <gtest/gtest.h>

#include "../recording/temporary_directory.hpp"

namespace crane::dashboard {
namespace {

namespace fs = std::filesystem;
using recording::put_contents;

class RunsTest : public testing::Test {
 protected:
  RunsTest() {
    for (const auto* made : {"runs/move", "runs/a/b/c", "uploads"}) fs::create_directories(directory_ / made);
    put_contents(directory_ / "secret.mcap", "not for the page");
    put_contents(directory_ / "runs/stop.mcap", "12345");
    put_contents(directory_ / "runs/move/recording.mcap", "1");
    put_contents(directory_ / "runs/move/run.csv", "time_s\n");
    put_contents(directory_ / "runs/move/rig.toml", "");
    put_contents(directory_ / "runs/a/b/c/too_deep.mcap", "1");
    fs::create_symlink(directory_ / "secret.mcap", directory_ / "runs/link.mcap");
    fs::create_directory_symlink(directory_ / "uploads", directory_ / "runs/elsewhere");
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& run : runs_.list()) all.push_back(run.name);
    std::sort(all.begin(), all.end());
    return all;
  }
  recording::TemporaryDirectory directory_;
  Runs runs_{directory_ / "runs", directory_ / "uploads"};
};

TEST_F(RunsTest, AreTheRecordingsAndTablesOfTheDirectoryAndNoLinks) {
  EXPECT_EQ(names(), (std::vector<std::string>{"move/recording.mcap", "move/run.csv", "stop.mcap"}));
  const auto found = runs_.find("stop.mcap");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bytes, 5U);
  EXPECT_TRUE(found->recording);
  EXPECT_FALSE(found->too_large());
  EXPECT_FALSE(runs_.find("move/run.csv")->recording);
}

TEST_F(RunsTest, AreFoundByTheirNamesOnlyWhateverPathIsAskedFor) {
  for (const std::string& name :
       {std::string{"../secret.mcap"}, (directory_ / "secret.mcap").string(), std::string{"link.mcap"},
        std::string{"move/../stop.mcap"}, std::string{"./stop.mcap"}, std::string{"elsewhere/x.mcap"},
        std::string{"stop.mcap\0", 10}, std::string{"upload:../secret.mcap"}, std::string{""},
        std::string{"move/rig.toml"}})
    EXPECT_FALSE(runs_.find(name)) << name;
}

TEST_F(RunsTest, OfUploadsKeepTheirNamesAndStayBelowTheBounds) {
  EXPECT_EQ(runs_.keep("lab.csv", "time_s\n0\n"), "");
  EXPECT_TRUE(runs_.find("upload:lab.csv"));
  EXPECT_EQ(runs_.keep("lab.csv", "time_s\n"), "") << "replaced";
  EXPECT_EQ(runs_.find("upload:lab.csv")->bytes, 7U);
  for (const auto* name : {"../lab.csv", "a/b.csv", ".hidden.csv", "lab.toml", "", "lab.csv ", "lab\n.csv"})
    EXPECT_NE(runs_.keep(name, "1"), "") << name;
  EXPECT_NE(runs_.keep("empty.csv", ""), "");
  const std::string large(16U << 20U, '1');
  for (int i = 0; i < 3; ++i) EXPECT_EQ(runs_.keep("large_" + std::to_string(i) + ".csv", large), "");
  EXPECT_NE(runs_.keep("large_3.csv", large), "") << "64 MB with what is there";
}

TEST_F(RunsTest, AreAtMostAsManyAsTheListHolds) {
  for (std::size_t i = 0; i < Runs::kMostListed + 20; ++i)
    put_contents(directory_ / ("runs/" + std::to_string(i) + ".mcap"), "1");
  EXPECT_EQ(runs_.list().size(), Runs::kMostListed);
}

TEST(RunsWithoutADirectory, AreNone) {
  const Runs none{"", ""};
  EXPECT_TRUE(none.list().empty());
  EXPECT_NE(none.keep("lab.csv", "1"), "");
  const Runs gone{"/there/is/no/such/directory", ""};
  EXPECT_TRUE(gone.list().empty());
}

}  // namespace
}  // namespace crane::dashboard
