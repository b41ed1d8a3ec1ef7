// The directory of `crane keys make`, and the message for each defect.
#include "crane/security/keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iostream>

#include "../recording/temporary_directory.hpp"

namespace crane::security {
namespace {

using recording::contents_of;
using recording::put_contents;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::int64_t kDay_s = 24 * 3600;

class Keys : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path directory() const { return temporary_ / "keys"; }
  void SetUp() override { make(directory(), valid_for(30)); }
  [[nodiscard]] std::vector<std::string> problems_of(std::string_view role,
                                                     std::string_view vendor = "cyclone") const {
    return problems(identity(directory(), role, vendor), vendor);
  }
  static mode_t mode_of(const std::filesystem::path& file) {
    struct stat status {};
    EXPECT_EQ(::stat(file.c_str(), &status), 0) << file;
    return status.st_mode & 0777U;
  }
  static void change(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    auto text = contents_of(file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    put_contents(file, text.replace(at, from.size(), to));
  }
  recording::TemporaryDirectory temporary_;
};

TEST_F(Keys, AreUsableForEveryRoleAndVendor) {
  const auto all = entries(directory());
  EXPECT_EQ(all.size(), roles().size() * std::size(kVendors));
  for (const auto& entry : all) EXPECT_THAT(entry.problems, IsEmpty()) << entry.subject;
}

TEST_F(Keys, AreReadableByTheirOwnerOnly) {
  for (const auto& file : std::filesystem::recursive_directory_iterator{directory()})
    EXPECT_EQ(mode_of(file.path()), file.is_directory() ? 0700U : 0600U) << file.path();
  EXPECT_EQ(mode_of(directory()), 0700U);
}

TEST_F(Keys, AreNeverOverwritten) {
  EXPECT_THROW(make(directory(), valid_for(30)), std::runtime_error);
  EXPECT_THAT(problems_of("supervisor"), IsEmpty());
}

/// A limit of the size of files acts like a full disk.
TEST_F(Keys, ThatCannotBeWrittenLeaveNoFile) {
  const auto full = temporary_ / "full";
  const auto make_and_exit = [&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      make(full, valid_for(10));
    } catch (const std::runtime_error& error) {
      std::cerr << error.what();
    }
    std::exit(3);
  };
  EXPECT_EXIT(make_and_exit(), testing::ExitedWithCode(3), "cannot write .*full");
  EXPECT_FALSE(std::filesystem::exists(full));
}

TEST(Roles, OnlyTheSupervisorMayWriteCommands) {
  for (const auto& role : roles()) {
    const bool may = testing::Value(writes(role), Contains("crane/command"));
    EXPECT_EQ(may, role.name == "supervisor") << role.name;
  }
}

TEST(Roles, OnlyTheOperatorMayWriteRequestsAndAMonitorMayWriteNothing) {
  for (const auto& role : roles()) {
    const bool may = testing::Value(writes(role), Contains("crane/request"));
    EXPECT_EQ(may, role.name == "operator") << role.name;
  }
  EXPECT_THAT(writes(*role_named("monitor")), IsEmpty());
}

TEST(Roles, EveryProcessHasOne) {
  for (int source = crane_SOURCE_NONE + 1; source <= crane_SOURCE_TWIN; ++source)
    EXPECT_NE(role_of(static_cast<crane_Source>(source)), nullptr) << source;
  EXPECT_EQ(role_of(crane_SOURCE_NONE), nullptr);
}

TEST_F(Keys, OfAnotherAuthorityAreRefused) {
  make(temporary_ / "other", valid_for(30));
  const auto mine = identity(directory(), "supervisor", "cyclone");
  const auto other = identity(temporary_ / "other", "supervisor", "cyclone");
  for (const auto& [from, to] : {std::pair{other.certificate, mine.certificate}, {other.key, mine.key}})
    std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(problems_of("supervisor"),
              ElementsAre(AllOf(HasSubstr("certificate.pem"), HasSubstr("not signed by"),
                                HasSubstr("copy the file"))));
}

TEST_F(Keys, ThatExpiredAreNamedWithTheirDate) {
  const auto now_s = static_cast<std::int64_t>(std::time(nullptr));
  make(temporary_ / "old", {now_s - 3 * kDay_s, now_s - kDay_s});
  EXPECT_THAT(problems(identity(temporary_ / "old", "operator", "fastdds"), "fastdds"),
              Contains(AllOf(HasSubstr("operator/fastdds/certificate.pem"), HasSubstr("expired on"),
                             HasSubstr("must be valid now"), HasSubstr("crane keys make"))));
}

TEST_F(Keys, ThatEndWithin30DaysAreNamedWithTheirDate) {
  const std::int64_t now_s = 1'800'000'000;  // 2027-01-15 08:00 UTC
  const auto keys = temporary_ / "ending";
  make(keys, {now_s - kDay_s, now_s + 40 * kDay_s});
  EXPECT_EQ(warning_of_end(keys, now_s), "");
  EXPECT_EQ(warning_of_end(keys, now_s + 9 * kDay_s), "");
  EXPECT_THAT(warning_of_end(keys, now_s + 11 * kDay_s),
              AllOf(HasSubstr(keys.string()), HasSubstr("ends on 2027-02-24 08:00 UTC"),
                    HasSubstr("crane keys make")));
  const auto all = ends(keys);
  EXPECT_THAT(all, SizeIs(2 + roles().size() * std::size(kVendors) * 2));
  for (const auto& end : all) EXPECT_EQ(end.until_s, now_s + 40 * kDay_s) << end.file;
}

TEST_F(Keys, ReportTheFileThatExpiresFirst) {
  const auto now_s = static_cast<std::int64_t>(std::time(nullptr));
  make(temporary_ / "later", valid_for(300));
  EXPECT_EQ(warning_of_end(temporary_ / "later", now_s), "");
  const auto ending = identity(directory(), "supervisor", "cyclone").permissions;
  const auto file = identity(temporary_ / "later", "supervisor", "cyclone").permissions;
  std::filesystem::copy_file(ending, file, std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(warning_of_end(temporary_ / "later", now_s + kDay_s), HasSubstr(file.string() + ": ends on"));
}

TEST_F(Keys, ThatAreNotYetValidNameTheClockAsReason) {
  const auto now_s = static_cast<std::int64_t>(std::time(nullptr));
  make(temporary_ / "new", {now_s + kDay_s, now_s + 2 * kDay_s});
  EXPECT_THAT(problems(identity(temporary_ / "new", "operator", "fastdds"), "fastdds"),
              Contains(AllOf(HasSubstr("is valid from"), HasSubstr("clock"))));
}

TEST_F(Keys, AChangedGovernanceIsRefused) {
  change(directory() / "governance.smime", "<allow_unauthenticated_participants>false",
         "<allow_unauthenticated_participants>true");
  EXPECT_THAT(problems_of("bridge"),
              ElementsAre(AllOf(HasSubstr("governance.smime"), HasSubstr("was changed"),
                                HasSubstr("copy the file"))));
}

TEST_F(Keys, ChangedPermissionsAreRefused) {
  const auto files = identity(directory(), "monitor", "fastdds");
  change(files.permissions, "<subscribe>", "<publish>");
  EXPECT_THAT(problems_of("monitor", "fastdds"),
              ElementsAre(AllOf(HasSubstr("permissions.smime"), HasSubstr("was changed"))));
}

TEST_F(Keys, PermissionsOfAnotherIdentityAreRefused) {
  std::filesystem::copy_file(identity(directory(), "supervisor", "cyclone").permissions,
                             identity(directory(), "monitor", "cyclone").permissions,
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(problems_of("monitor"), ElementsAre(HasSubstr("does not name CN=monitor.cyclone")));
}

TEST_F(Keys, AKeyThatOthersMayReadIsRefusedWithTheRemedy) {
  const auto key = identity(directory(), "operator", "cyclone").key;
  ::chmod(key.c_str(), 0640);
  EXPECT_THAT(problems_of("operator"),
              ElementsAre(AllOf(HasSubstr("mode 640"), HasSubstr("chmod 600 " + key.string()))));
}

TEST_F(Keys, AnIdentityOfTheOtherVendorIsRefused) {
  EXPECT_THAT(problems(identity(directory(), "tracking", "fastdds"), "cyclone"),
              ElementsAre(AllOf(HasSubstr("CN=tracking.fastdds"), HasSubstr("0x80"))));
}

/// Files of one role in the directory of another one.
TEST_F(Keys, OfAnotherRoleAreRefused) {
  for (const auto& [from, to] : {std::pair{"supervisor", "operator"}, {"monitor", "operator"}}) {
    std::filesystem::copy(
        directory() / from, directory() / to,
        std::filesystem::copy_options::overwrite_existing | std::filesystem::copy_options::recursive);
    EXPECT_THAT(problems_of(to),
                Contains(AllOf(HasSubstr("operator/cyclone/certificate.pem: subject CN=" + std::string{from}),
                               HasSubstr("is the identity of another role than operator"))));
    EXPECT_THAT(problems_of(to), Contains(AllOf(HasSubstr("permissions.smime"),
                                                HasSubstr("other topics than those of the role operator"))));
  }
}

/// A user who can write one of these can give the crane other authorities.
TEST_F(Keys, DirectoriesAndFilesThatOthersMayWriteAreRefusedWithTheRemedy) {
  const auto files = identity(directory(), "operator", "cyclone");
  for (const auto& path :
       {directory(), directory() / "operator", directory() / "operator" / "cyclone", files.identity_ca,
        files.permissions_ca, files.governance, files.certificate, files.permissions})
    for (const mode_t writable : {S_IWGRP, S_IWOTH}) {
      const auto mode = mode_of(path);
      ASSERT_EQ(::chmod(path.c_str(), mode | writable), 0);
      EXPECT_THAT(problems_of("operator"), ElementsAre(AllOf(HasSubstr(path.string() + ": mode "),
                                                             HasSubstr("must not be able to write"),
                                                             HasSubstr("chmod go-w " + path.string()))));
      ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    }
}

TEST_F(Keys, EachFileThatIsMissingIsNamed) {
  const auto files = identity(directory(), "planner", "cyclone");
  std::filesystem::remove(files.key);
  std::filesystem::remove(files.governance);
  EXPECT_THAT(problems_of("planner"),
              AllOf(SizeIs(2), Contains(HasSubstr("key.pem")), Contains(HasSubstr("governance"))));
}

}  // namespace
}  // namespace crane::security
