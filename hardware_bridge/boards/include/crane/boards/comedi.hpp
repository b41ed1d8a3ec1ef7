#pragma once
/// Driver of boards that Linux's comedi drives (libcomedi): counters, analog outputs, digital lines, by the
/// subdevices that [wiring] of the rig file names.
///
/// Counters: 24 bit or more, their lowest 24 bits are used; quadrature, four counts a line. One instruction
///   list reads all of them and the inputs. At the start they are preset to [start] of the rig file.
/// Converters: any resolution, on a range that reaches 9.9 V both ways; clamped to it, not finite: 0 V.
/// Lines: input 0..15 is channel 0..15 of the input subdevice, output 16..31 channel 0..15 of the output
///   subdevice. Inputs active low, contacts closed when all is well. Outputs: on is high.
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
  /// Locks the subdevices, checks all of them, then makes the board safe, then starts the counters.
  /// @throws BoardError when there is no such device, another program has it, or a subdevice is not what the
  ///   rig file says
  explicit Comedi(const configuration::Rig& rig);
  /// Leaves the board at 0 V, all outputs off.
  ~Comedi() override;
  Comedi(const Comedi&) = delete;
  Comedi& operator=(const Comedi&) = delete;

  [[nodiscard]] std::string_view name() const override { return name_; }
  /// @throws BoardError when the device does not answer; so does write()
  [[nodiscard]] Inputs read() override;
  std::array<double, kDrives> write(const Outputs& outputs) override;
  void make_safe() noexcept override;
  void advance_to(std::int64_t /*time_ns*/) override {}

 private:
  /// Closes the device when the constructor throws, too.
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
    std::int32_t start_counts = 0;
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
