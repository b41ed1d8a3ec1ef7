#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "crane/boards/registry.hpp"
#include "crane/boards/servo_to_go.hpp"
#include "crane/boards/shared_lines.hpp"

namespace crane::bridge {
namespace {

/// A socket name that only one process of this network namespace can have. No user can remove the name; the
/// kernel releases it when the process ends.
class SocketName {
 public:
  SocketName() : socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    if (socket_ < 0)
      throw BoardError{std::string{"socket for the lock of the board: "} + std::strerror(errno)};
  }
  ~SocketName() { ::close(socket_); }
  SocketName(const SocketName&) = delete;
  SocketName& operator=(const SocketName&) = delete;

  /// @return false when another socket has this name
  [[nodiscard]] bool take(const std::string& name) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    // The first byte stays 0: the name is abstract, without a file.
    std::copy_n(name.begin(), std::min(name.size(), sizeof address.sun_path - 1), address.sun_path + 1);
    return ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }

 private:
  int socket_;
};

/// Two bridges on one card would overwrite each other's outputs. The file excludes a bridge in another
/// network namespace. The socket excludes a bridge after the file has been removed: logind removes the shared
/// memory of a user who logs out (RemoveIPC).
class CardLock {
 public:
  explicit CardLock(int base_address)
      : name_{"/crane_servo_to_go_" + std::to_string(base_address)}, file_{name_} {}
  [[nodiscard]] bool take() { return file_.take(SharedFile::Role::bridge) && socket_.take(name_); }

 private:
  std::string name_;
  SharedFile file_;
  SocketName socket_;
};

class OwnedServoToGo final : public Board {
 public:
  explicit OwnedServoToGo(const configuration::Rig& rig)
      : lock_{rig.wiring.base_address}, card_{rig, ports(rig)} {}

  [[nodiscard]] std::string_view name() const override { return card_.name(); }
  [[nodiscard]] Inputs read() override { return card_.read(); }
  std::array<double, kDrives> write(const Outputs& outputs) override { return card_.write(outputs); }
  void make_safe() noexcept override { card_.make_safe(); }
  void advance_to(std::int64_t /*time_ns*/) override {}

 private:
  std::unique_ptr<PortIo> ports(const configuration::Rig& rig) {
    if (!lock_.take())
      throw BoardError(
          "another hardware bridge uses this board: stop it first, or correct base_address in [wiring]");
    return open_ports(static_cast<std::uint16_t>(rig.wiring.base_address));
  }
  CardLock lock_;
  ServoToGo card_;
};

}  // namespace

std::unique_ptr<Board> make_servo_to_go_board(const configuration::Rig& rig, const bus::Options& /*bus*/) {
  return std::make_unique<OwnedServoToGo>(rig);
}

}  // namespace crane::bridge
