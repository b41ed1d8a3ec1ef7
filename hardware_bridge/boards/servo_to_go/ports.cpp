#include <cerrno>
#include <cstring>
#include <string>

#include "crane/boards/port_io.hpp"
#include "registers.hpp"

#if defined(__x86_64__) || defined(__i386__)
#include <sys/io.h>

namespace crane::bridge {
namespace {

std::string refusal(int error) {
  if (error == ENOSYS)
    return "this kernel gives no program access to I/O ports: boot a kernel with CONFIG_X86_IOPL_IOPERM "
           "(the Debian kernel has this option)";
  return std::string{"no permission for the I/O ports of the board: "} + std::strerror(error) +
         "; run as root, or `setcap cap_sys_rawio,cap_sys_nice,cap_ipc_lock+ep` on crane_hardware_bridge and "
         "crane; if root is refused, too, switch Secure Boot off";
}

class SystemPorts final : public PortIo {
 public:
  explicit SystemPorts(std::uint16_t base_address) {
    for (const unsigned long first : {static_cast<unsigned long>(base_address),
                                      base_address + static_cast<unsigned long>(servo_to_go::kSecondWindow)})
      if (::ioperm(first, servo_to_go::kWindow, 1) != 0) throw BoardError(refusal(errno));
  }
  [[nodiscard]] std::uint8_t in_8(std::uint16_t port) noexcept override { return ::inb(port); }
  [[nodiscard]] std::uint16_t in_16(std::uint16_t port) noexcept override { return ::inw(port); }
  void out_8(std::uint16_t port, std::uint8_t value) noexcept override { ::outb(value, port); }
  void out_16(std::uint16_t port, std::uint16_t value) noexcept override { ::outw(value, port); }
};

}  // namespace

std::unique_ptr<PortIo> open_ports(std::uint16_t base_address) {
  return std::make_unique<SystemPorts>(base_address);
}

}  // namespace crane::bridge

#else

namespace crane::bridge {

std::unique_ptr<PortIo> open_ports(std::uint16_t /*base_address*/) {
  throw BoardError(
      "this processor has no I/O ports: a Servo-to-Go board needs an x86 machine with an ISA bus");
}

}  // namespace crane::bridge

#endif
