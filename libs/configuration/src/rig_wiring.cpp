#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

constexpr int kLastInput = 15;    // ports A and B
constexpr int kFirstOutput = 16;  // ports C and D
constexpr int kLastOutput = 31;
constexpr int kFirstAddress = 0x200, kLastAddress = 0x3E0, kAddressStep = 0x20;

/// Reads line numbers; each input and each output belongs to one signal.
class Lines {
 public:
  int input(TomlTable& table, std::string_view key, int fallback) {
    return checked(table, key, table.integer(key, 0, kLastInput, fallback));
  }
  int output(TomlTable& table, std::string_view key, int fallback) {
    return checked(table, key, table.integer(key, kFirstOutput, kLastOutput, fallback));
  }

 private:
  int checked(TomlTable& table, std::string_view key, int line) {
    check_unique(table, key, line, taken_);
    return line;
  }
  std::vector<int> taken_;
};

int read_address(TomlTable& table, int fallback) {
  const int address = table.integer("base_address", kFirstAddress, kLastAddress, fallback);
  if ((address - kFirstAddress) % kAddressStep != 0)
    table.problem("base_address", "must be 0x200 + 0x20 n, as the board's jumpers are set");
  return address;
}

void read_subdevices(TomlTable& table, Wiring& wiring) {
  constexpr int kLastSubdevice = 63;
  std::vector<int> taken;
  const auto read = [&](std::string_view key, int& subdevice) {
    subdevice = table.integer(key, 0, kLastSubdevice, subdevice);
    check_unique(table, key, subdevice, taken);
  };
  read("counter_subdevice", wiring.counter_subdevice);
  read("analog_output_subdevice", wiring.analog_output_subdevice);
  read("input_subdevice", wiring.input_subdevice);
  read("output_subdevice", wiring.output_subdevice);
}

}  // namespace

void read_wiring(TomlTable& root, Rig& rig) {
  TomlTable table = root.table("wiring");
  Wiring& wiring = rig.wiring;
  Lines lines;
  wiring.base_address = read_address(table, wiring.base_address);
  wiring.device = table.text("device", wiring.device);
  read_subdevices(table, wiring);
  wiring.estop_input = lines.input(table, "estop_input", wiring.estop_input);
  wiring.relay_closed_input = lines.input(table, "relay_closed_input", wiring.relay_closed_input);
  wiring.watchdog_output = lines.output(table, "watchdog_output", wiring.watchdog_output);
  wiring.relay_timeout_s = table.number("relay_timeout_s", Range::above(0, 1), wiring.relay_timeout_s);
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    if (!rig.drives[i].present) continue;
    TomlTable drive = table.table(kAxisTexts[i].name);
    DriveLines& of_drive = wiring.drives[i];
    of_drive.limit_low_input = lines.input(drive, "limit_low_input", of_drive.limit_low_input);
    of_drive.limit_high_input = lines.input(drive, "limit_high_input", of_drive.limit_high_input);
    of_drive.brake_closed_input = lines.input(drive, "brake_closed_input", of_drive.brake_closed_input);
    of_drive.brake_release_output =
        lines.output(drive, "brake_release_output", of_drive.brake_release_output);
    if (drive.has("mark_input")) of_drive.mark_input = lines.input(drive, "mark_input", 0);
  }
}

}  // namespace crane::configuration
