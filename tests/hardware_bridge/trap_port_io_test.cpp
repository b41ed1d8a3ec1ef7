// Runs the driver with real in and out instructions. Without permission each instruction faults; the signal
// handler of this program then emulates the card and lets the driver continue.
#include <sched.h>
#include <sys/io.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <optional>

#include "crane/boards/registry.hpp"
#include "subject.hpp"

namespace {

crane::bridge::PortIo* volatile card_behind_the_fault = nullptr;
volatile int permission_refused_with = 0;
volatile long faults = 0;

using Registers = greg_t*;

void put_low(Registers registers, unsigned bits, unsigned value) {
  const auto mask = (1LL << bits) - 1;
  registers[REG_RAX] = (registers[REG_RAX] & ~mask) | value;
}

/// in al|ax, dx; in al|ax, imm8; out dx, al|ax; out imm8, al|ax
void emulate(int /*signal*/, siginfo_t* /*info*/, void* context) {
  auto* registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  const auto* code = reinterpret_cast<const std::uint8_t*>(registers[REG_RIP]);
  const bool wide = code[0] == 0x66;
  const auto* instruction = code + (wide ? 1 : 0);
  const bool from_dx = (*instruction & 8U) != 0;
  const auto port = static_cast<std::uint16_t>(from_dx ? registers[REG_RDX] : instruction[1]);
  auto& card = *card_behind_the_fault;
  switch (*instruction & 0xF7U) {
    case 0xE4:
      put_low(registers, 8, card.in_8(port));
      break;
    case 0xE5:
      put_low(registers, 16, card.in_16(port));
      break;
    case 0xE6:
      card.out_8(port, static_cast<std::uint8_t>(registers[REG_RAX]));
      break;
    case 0xE7:
      card.out_16(port, static_cast<std::uint16_t>(registers[REG_RAX]));
      break;
    default:
      std::signal(SIGSEGV, SIG_DFL);  // a real fault
      return;
  }
  faults = faults + 1;
  registers[REG_RIP] += (instruction - code) + (from_dx ? 1 : 2);
}

}  // namespace

/// Replaces the function of the C library, so that the test needs no permission of the kernel.
extern "C" int ioperm(unsigned long /*from*/, unsigned long /*count*/, int /*on*/) noexcept {
  if (permission_refused_with == 0) return 0;
  errno = permission_refused_with;
  return -1;
}

namespace crane::bridge::test {
namespace {

class TrappedCard : public testing::Test {
 protected:
  TrappedCard() {
    struct sigaction action {};
    action.sa_sigaction = emulate;
    action.sa_flags = SA_SIGINFO;
    ::sigaction(SIGSEGV, &action, &before_);
    move_card_to(0x200);
  }
  ~TrappedCard() override { ::sigaction(SIGSEGV, &before_, nullptr); }

  configuration::Rig rig_ = emulated_rig();
  WiredRig crane_{rig_};
  /// Address of the card, different for each test with a lock, because CTest runs tests in parallel.
  void move_card_to(std::uint16_t base_address) {
    rig_.wiring.base_address = base_address;
    card_.emplace(base_address, crane_.card(), crane_);
    card_behind_the_fault = &*card_;
  }
  std::optional<EmulatedServoToGo> card_;
  struct sigaction before_ {};
};

TEST_F(TrappedCard, RunsTheUnchangedDriverWithRealInstructions) {
  CardSubject reference{rig_, 1};
  {
    ServoToGo board{rig_, open_ports(0x200)};
    EXPECT_EQ(board.name(), "servo_to_go model 1");
    for (int tick = 0; tick < 60; ++tick) {
      const double v = tick < 12 ? 0 : (tick < 40 ? 6 : -10);
      const Outputs outputs{{v, -v / 2, v / 4}, {true, true, true}, tick % 2 == 0};
      EXPECT_EQ(board.write(outputs), reference.board().write(outputs));
      crane_.advance_to(crane_.now_ns() + kTick_ns);
      reference.pass(kTick_ns);
      EXPECT_EQ(board.read().raw_counts, reference.board().read().raw_counts) << tick;
      EXPECT_EQ(board.read().brake_closed, reference.board().read().brake_closed) << tick;
    }
    EXPECT_EQ(crane_.crane().truth(), reference.crane().truth());
    EXPECT_GT(crane_.crane().truth().trolley_m, rig_.start.position[0] + 0.1);
  }
  EXPECT_EQ(crane_.drive_v(), (std::array<double, kDrives>{}));
  EXPECT_GT(faults, 60 * 40);
}

/// Message of the driver when the kernel refuses with `error`.
std::string refusal(int error) {
  permission_refused_with = error;
  std::string text = "accepted";
  try {
    (void)open_ports(0x200);
  } catch (const BoardError& refused) {
    text = refused.what();
  }
  permission_refused_with = 0;
  return text;
}

TEST_F(TrappedCard, WithoutPermissionIsRefusedWithTheRemedy) {
  EXPECT_THAT(refusal(EPERM), testing::AllOf(testing::HasSubstr("no permission for the I/O ports"),
                                             testing::HasSubstr("cap_sys_rawio")));
}

TEST_F(TrappedCard, OnAKernelWithoutPortAccessIsRefusedWithTheMissingOption) {
  EXPECT_THAT(refusal(ENOSYS), testing::AllOf(testing::HasSubstr("CONFIG_X86_IOPL_IOPERM"),
                                              testing::Not(testing::HasSubstr("run as root"))));
}

/// Message of the board when a second bridge opens the card; "accepted" when it does.
std::string refusal_of_a_second_bridge(const configuration::Rig& rig) {
  try {
    (void)make_servo_to_go_board(rig, {});
  } catch (const BoardError& refused) {
    return refused.what();
  }
  return "accepted";
}
const auto kAnotherBridge = testing::HasSubstr("another hardware bridge uses this board");

TEST_F(TrappedCard, IsRefusedToASecondBridgeUntilTheFirstHasEnded) {
  move_card_to(0x220);
  auto first = make_servo_to_go_board(rig_, {});
  const auto before = faults;
  EXPECT_THAT(refusal_of_a_second_bridge(rig_), kAnotherBridge);
  EXPECT_EQ(faults, before) << "the second bridge has accessed the card";
  first.reset();
  EXPECT_EQ(refusal_of_a_second_bridge(rig_), "accepted");
}

/// logind removes the shared memory of a user who logs out; the bridge of this user continues.
TEST_F(TrappedCard, IsRefusedToASecondBridgeAfterTheSharedMemoryWasRemoved) {
  move_card_to(0x240);
  const auto first = make_servo_to_go_board(rig_, {});
  ASSERT_EQ(::shm_unlink(("/crane_servo_to_go_" + std::to_string(rig_.wiring.base_address)).c_str()), 0);
  const auto before = faults;
  EXPECT_THAT(refusal_of_a_second_bridge(rig_), kAnotherBridge);
  EXPECT_EQ(faults, before) << "the second bridge has accessed the card";
}

TEST_F(TrappedCard, IsRefusedToASecondBridgeInAnotherNetworkNamespace) {
  move_card_to(0x260);
  const auto first = make_servo_to_go_board(rig_, {});
  const auto child = ::fork();
  if (child == 0) {
    if (::unshare(CLONE_NEWNET) != 0) ::_exit(2);
    ::_exit(testing::Matches(kAnotherBridge)(refusal_of_a_second_bridge(rig_)) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WEXITSTATUS(status) == 2) GTEST_SKIP() << "a network namespace needs root";
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace crane::bridge::test
