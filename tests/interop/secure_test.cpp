// DDS Security across processes and vendors: programs with an identity of the crane's authority communicate
// with the permissions of their role; all other programs neither read nor write.
#include <sys/wait.h>

#include <csignal>
#include <ctime>
#include <thread>

#include "../recording/temporary_directory.hpp"
#include "crane/security/keys.hpp"
#include "stage.hpp"

namespace crane::bus::testing {
namespace {

constexpr std::uint32_t kDomain = 49;

Options secured(const std::filesystem::path& keys, const char* role, Vendor vendor,
                const std::string& crane) {
  const auto files = security::identity(keys, role, to_string(vendor));
  auto result = options(vendor, kDomain);
  result.crane = crane;
  result.credentials = Credentials{files.identity_ca,    files.certificate, files.key,
                                   files.permissions_ca, files.governance,  files.permissions};
  return result;
}

/// A separate process: a bridge that publishes states with the number of received commands.
class BridgeProcess {
 public:
  BridgeProcess(const std::filesystem::path& keys, Vendor vendor, const std::string& crane) : pid_{::fork()} {
    if (pid_ == 0) run(secured(keys, "bridge", vendor, crane));
  }
  ~BridgeProcess() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  BridgeProcess(const BridgeProcess&) = delete;
  BridgeProcess& operator=(const BridgeProcess&) = delete;

 private:
  [[noreturn]] static void run(const Options& options) {
    Bus bus{options};
    auto states = bus.publisher(topics::state);
    auto commands = bus.subscriber(topics::command);
    for (msg::State state{};; ++state.header.tick) {
      bus.wait(10ms);
      while (commands.take()) ++state.counts[0];
      (void)states.publish(state);
    }
  }
  pid_t pid_;
};

class Secure : public ::testing::Test {
 protected:
  void SetUp() override { security::make(keys(), security::valid_for(1)); }
  [[nodiscard]] std::filesystem::path keys() const { return directory_ / "keys"; }

  recording::TemporaryDirectory directory_;
  std::string crane_ = "secure_" + std::to_string(::getpid());
};

class SecurePair : public Secure, public ::testing::WithParamInterface<VendorPair> {};

TEST_P(SecurePair, StatesAndCommandsCrossBetweenTwoProcesses) {
  const BridgeProcess bridge{keys(), GetParam().writer, crane_};
  Bus bus{secured(keys(), "supervisor", GetParam().reader, crane_)};
  auto states = bus.subscriber(topics::state);
  auto commands = bus.publisher(topics::command);
  ASSERT_TRUE(eventually(bus, [&] {
    (void)commands.publish({});
    const auto state = states.take();
    return state && state->counts[0] > 0;
  })) << "no state that says that a command was heard";
}

INSTANTIATE_TEST_SUITE_P(Vendors, SecurePair, kAllPairs,
                         [](const auto& test) { return name_of(test.param); });

/// A program that tries to read and to command.
struct Attacker {
  explicit Attacker(const Options& options)
      : bus{options}, states{bus.subscriber(topics::state)}, commands{bus.publisher(topics::command)} {}
  bool succeeds() {
    (void)commands.publish({});
    return states.take() || states.matched() > 0 || commands.matched() > 0;
  }
  Bus bus;
  Subscriber<msg::State> states;
  Publisher<msg::Command> commands;
};

class Intruder : public Secure, public ::testing::WithParamInterface<VendorPair> {
 protected:
  /// While a monitor with keys receives samples of the bridge for 1 s, this attacker receives nothing, and no
  /// program receives the samples of the attacker.
  void expect_shut_out(const Options& attacker_options) {
    const BridgeProcess bridge{keys(), GetParam().reader, crane_};
    Attacker attacker{attacker_options};
    Bus bus{secured(keys(), "monitor", Vendor::fastdds, crane_)};
    auto states = bus.subscriber(topics::state);
    ASSERT_TRUE(eventually(bus, [&] { return states.take().has_value(); })) << "the monitor hears nothing";
    const auto end = std::chrono::steady_clock::now() + 1s;
    while (std::chrono::steady_clock::now() < end) {
      bus.wait(20ms);
      ASSERT_FALSE(attacker.succeeds());
      while (const auto state = states.take()) ASSERT_EQ(state->counts[0], 0) << "the bridge heard a command";
    }
  }
};

TEST_P(Intruder, WithoutACertificateIsShutOut) {
  auto open = options(GetParam().writer, kDomain);
  open.crane = crane_;
  expect_shut_out(open);
}

TEST_P(Intruder, OfAnotherAuthorityIsShutOut) {
  security::make(directory_ / "rogue", security::valid_for(1));
  expect_shut_out(secured(directory_ / "rogue", "supervisor", GetParam().writer, crane_));
}

TEST_P(Intruder, WhoseCertificateExpiredCannotJoin) {
  const auto now_s = static_cast<std::int64_t>(std::time(nullptr));
  constexpr std::int64_t kDay_s = 24 * 3600;
  std::filesystem::remove_all(keys());
  security::make(keys(), {now_s - 2 * kDay_s, now_s - kDay_s});
  EXPECT_THROW(Attacker{secured(keys(), "supervisor", GetParam().writer, crane_)}, Error);
}

INSTANTIATE_TEST_SUITE_P(Vendors, Intruder,
                         ::testing::Values(VendorPair{Vendor::cyclone, Vendor::cyclone},
                                           VendorPair{Vendor::fastdds, Vendor::cyclone}),
                         [](const auto& test) { return name_of(test.param); });

class ReadOnly : public Secure, public ::testing::WithParamInterface<Vendor> {};

TEST_P(ReadOnly, IdentityCannotCreateAWriterOfCommandsAndIsTold) {
  Bus bus{secured(keys(), "monitor", GetParam(), crane_)};
  try {
    (void)bus.publisher(topics::command);
    FAIL() << "created";
  } catch (const Error& error) {
    for (const char* part : {"writer of crane/command", "monitor/", "crane keys show"})
      EXPECT_NE(std::string{error.what()}.find(part), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW((void)bus.subscriber(topics::command));
}

TEST_P(ReadOnly, OperatorCannotCreateAWriterOfCommandsEither) {
  Bus bus{secured(keys(), "operator", GetParam(), crane_)};
  EXPECT_THROW((void)bus.publisher(topics::command), Error);
  EXPECT_NO_THROW((void)bus.publisher(topics::request));
}

TEST_P(ReadOnly, GovernanceThatWasChangedLetsNobodyJoin) {
  const auto file = keys() / "governance.smime";
  auto text = recording::contents_of(file);
  const std::string strict = "<allow_unauthenticated_participants>false";
  text.replace(text.find(strict), strict.size(), "<allow_unauthenticated_participants>true ");
  recording::put_contents(file, text);
  EXPECT_THROW((Bus{secured(keys(), "supervisor", GetParam(), crane_)}), Error);
}

INSTANTIATE_TEST_SUITE_P(Vendors, ReadOnly, ::testing::Values(Vendor::cyclone, Vendor::fastdds),
                         [](const auto& test) { return std::string{to_string(test.param)}; });

}  // namespace
}  // namespace crane::bus::testing
