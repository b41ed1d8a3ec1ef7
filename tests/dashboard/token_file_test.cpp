#include "dashboard/token_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "crane/configuration/rig.hpp"

namespace crane::dashboard {
namespace {

class TokenFile : public testing::Test {
 protected:
  TokenFile() { std::filesystem::remove(file_); }
  ~TokenFile() override { std::filesystem::remove(file_); }
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("crane_token_" + std::to_string(::getpid()));
};

TEST_F(TokenFile, IsCreatedOnceAndReadableByItsOwnerOnly) {
  const auto token = read_or_make_token(file_);
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(read_or_make_token(file_), token);
  struct stat status {};
  ASSERT_EQ(::stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(TokenFile, ThatOthersCanReadIsRefused) {
  (void)read_or_make_token(file_);
  ::chmod(file_.c_str(), 0640);
  EXPECT_THROW((void)read_or_make_token(file_), configuration::ConfigurationError);
}

TEST_F(TokenFile, WithAShortTokenIsRefused) {
  std::ofstream{file_} << "short\n";
  ::chmod(file_.c_str(), 0600);
  EXPECT_THROW((void)read_or_make_token(file_), configuration::ConfigurationError);
}

TEST_F(TokenFile, WithALongTokenIsRefused) {
  std::ofstream{file_} << std::string(5'000'000, 'a');
  ::chmod(file_.c_str(), 0600);
  EXPECT_THROW((void)read_or_make_token(file_), configuration::ConfigurationError);
}

TEST_F(TokenFile, ThatIsALinkOrAPipeIsRefused) {
  const auto target = file_.string() + "_target";
  (void)read_or_make_token(target);
  std::filesystem::create_symlink(target, file_);
  EXPECT_THROW((void)read_or_make_token(file_), configuration::ConfigurationError);
  std::filesystem::remove(file_);
  std::filesystem::remove(target);
  ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
  EXPECT_THROW((void)read_or_make_token(file_), configuration::ConfigurationError);
}

}  // namespace
}  // namespace crane::dashboard
