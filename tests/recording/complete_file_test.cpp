#include "crane/recording/complete_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "crane/recording/mcap_writer.hpp"
#include "temporary_directory.hpp"

namespace crane::recording {
namespace {

using testing::HasSubstr;

class Replaced : public testing::Test {
 protected:
  static void replace(const std::filesystem::path& target,
                      std::span<const std::filesystem::path> sources = {}) {
    CompleteFile complete{target, sources};
    put_contents(complete.partial(), "new");
    complete.publish();
  }
  static std::string refusal_of(const std::filesystem::path& target,
                                std::span<const std::filesystem::path> sources = {}) {
    try {
      replace(target, sources);
    } catch (const WriteError& error) {
      return error.what();
    }
    return "accepted";
  }
  TemporaryDirectory directory;
  std::filesystem::path file = directory / "file";
};

TEST_F(Replaced, FileAppearsOnlyWhenItIsPublished) {
  {
    const CompleteFile complete{file};
    put_contents(complete.partial(), "half");
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  EXPECT_FALSE(std::filesystem::exists(directory / "file.partial"));
  replace(file);
  EXPECT_EQ(contents_of(file), "new");
}

TEST_F(Replaced, FileKeepsItsPermissionsAndALinkToIt) {
  put_contents(file, "old");
  std::filesystem::permissions(file,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  const auto link = directory / "link";
  std::filesystem::create_symlink("file", link);
  replace(link);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(contents_of(file), "new");
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(Replaced, DevicesPipesAndLinksToMissingFilesAreRefused) {
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(refusal_of(file), HasSubstr("is no regular file"));
  EXPECT_THAT(refusal_of("/dev/null"), HasSubstr("is no regular file"));
  EXPECT_THAT(refusal_of(directory / ""), HasSubstr("is no regular file"));
  std::filesystem::create_symlink("missing", directory / "link");
  EXPECT_THAT(refusal_of(directory / "link"), HasSubstr("is a link to a missing file"));
}

TEST_F(Replaced, AFileThatIsReadIsRefusedUnderEachOfItsNames) {
  put_contents(file, "precious");
  std::filesystem::create_hard_link(file, directory / "hard");
  std::filesystem::create_symlink("file", directory / "link");
  const std::array sources{file};
  for (const char* name : {"file", "hard", "link"})
    EXPECT_THAT(refusal_of(directory / name, sources), HasSubstr("is a file that the command reads"));
  EXPECT_EQ(contents_of(file), "precious");
}

}  // namespace
}  // namespace crane::recording
