#pragma once
/// Driver of all boards that Linux comedi supports (libcomedi): counters, analog outputs and digital lines of
/// the subdevices in [wiring] of the rig file.
///
/// Counters: at least 24 bits, of which the lowest 24 are used; quadrature, four counts per line. One
///   instruction list reads all counters and the inputs. The constructor presets the counters
///   (start_counts()).
/// Converters: any resolution, with a range of at least +-9.9 V. Voltages are limited to the range; a value
///   that is not finite gives 0 V.
/// Lines: input 0..15 is channel 0..15 of the input subdevice, output 16..31 is channel 0..15 of the output
///   subdevice. Inputs are active low (normally closed contacts). Outputs: on is high.
#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "crane/boards/port_io.hpp"
#include "crane/boards/rig_lines.hpp"
#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

struct comedi_t_struct;

namespace crane::bridge {

class Comedi final : public Board {
 public:
  /// Locks and checks the subdevices, makes the board safe, and starts the counters.
  /// @throws BoardError when the device is missing or in use, or a subdevice does not agree with the rig file
  explicit Comedi(const configuration::Rig& rig);
  /// Leaves the board at 0 V with all outputs off.
  ~Comedi() override;
  Comedi(const Comedi&) = delete;
  Comedi& operator=(const Comedi&) = delete;

  [[nodiscard]] std::string_view name() const override { return name_; }
  /// read() and write(): @throws BoardError when the device does not answer
  [[nodiscard]] Inputs read() override;
  std::array<double, kDrives> write(const Outputs& outputs) override;
  void make_safe() noexcept override;
  void advance_to(std::int64_t /*time_ns*/) override {}

 private:
  /// Closes the device, also when the constructor throws.
  struct Handle {
    comedi_t_struct* device = nullptr;
    Handle() = default;
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle();
  };
  struct Counter {
    std::size_t coordinate = 0;
    unsigned channel = 0;
    std::int64_t start_counts = 0;
  };
  struct Converter {
    std::size_t drive = 0;
    unsigned channel = 0, range = 0;
    double low_v = 0, high_v = 0;
    unsigned largest = 0;
  };

  void lock(int subdevice, std::initializer_list<int> types, const char* key);
  void require_channel(int subdevice, unsigned channel, const char* key) const;
  void find_converter(std::size_t drive, unsigned channel);
  void find_lines();
  void start_counter(const Counter& counter);
  [[nodiscard]] unsigned code(const Converter& converter, double voltage_v) const noexcept;
  [[nodiscard]] double voltage_v(const Converter& converter, unsigned code) const noexcept;
  [[noreturn]] void fail(const std::string& what) const;

  configuration::Wiring wiring_;
  RigLines lines_;
  Handle handle_;
  std::string name_;
  std::vector<Counter> counters_;
  std::vector<Converter> converters_;
  unsigned output_mask_ = 0;
};

}  // namespace crane::bridge
