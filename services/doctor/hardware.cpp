#include "doctor/hardware.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#if defined(__x86_64__) || defined(__i386__)
#include <sys/io.h>
#endif

namespace crane::doctor {
namespace {

Findings examine_device(const std::string& device) {
  if (::access(device.c_str(), R_OK | W_OK) == 0)
    return {{Grade::good, "hw", "board", device + " exists and can be opened", ""}};
  const int error = errno;
  const std::string what = device + ": " + std::strerror(error);
  if (error == ENOENT)
    return {{Grade::problem, "hw", "board_missing", what,
             "load the driver of the board (`modprobe DRIVER`, `dmesg`), or name the device in [wiring]"}};
  return {{Grade::problem, "hw", "board_refused", what, "put this user in the group of " + device}};
}

Findings examine_ports() {
#if defined(__x86_64__) || defined(__i386__)
  constexpr unsigned long kAnyPort = 0x200;  // permission is the same for all; nothing is read
  if (::ioperm(kAnyPort, 1, 1) == 0) {
    ::ioperm(kAnyPort, 1, 0);
    return {{Grade::good, "hw", "board", "this user may use I/O ports", ""}};
  }
  if (errno == ENOSYS)
    return {{Grade::problem, "hw", "board_refused", "this kernel gives no program access to I/O ports",
             "boot a kernel with CONFIG_X86_IOPL_IOPERM (the Debian kernel has this option)"}};
  return {{Grade::problem, "hw", "board_refused",
           std::string{"this user may not use I/O ports: "} + std::strerror(errno),
           "`setcap cap_sys_rawio,cap_sys_nice,cap_ipc_lock+ep` on crane_hardware_bridge and crane"}};
#else
  return {{Grade::problem, "hw", "board_missing", "this processor has no I/O ports",
           "a Servo-to-Go board needs an x86 computer with an ISA bus"}};
#endif
}

}  // namespace

Findings examine_board(const configuration::Rig& rig) {
  if (rig.board == "comedi") return examine_device(rig.wiring.device);
  if (rig.board == "servo_to_go") return examine_ports();
  return {{Grade::good, "hw", "board",
           "the rig " + rig.name + " has the board \"" + rig.board + "\": no hardware is needed", ""}};
}

}  // namespace crane::doctor
