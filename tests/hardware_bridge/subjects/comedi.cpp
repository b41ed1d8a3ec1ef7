#include "crane/boards/comedi.hpp"

#include "../comedi_stand_in.hpp"
#include "../subject.hpp"

namespace crane::bridge::test {
namespace {

/// The comedi driver on a stand-in of its library.
class ComediSubject final : public Subject {
 public:
  explicit ComediSubject(const configuration::Rig& rig)
      : device_{rig}, board_{std::make_unique<Comedi>(rig)} {}
  Board& board() override { return *board_; }
  simulator::SimulatedBoard& crane() override { return device_.rig().crane(); }
  std::array<double, kDrives> amplifier_v() override { return device_.rig().drive_v(); }
  void close() override { board_.reset(); }
  void pass(std::int64_t duration_ns) override {
    device_.rig().advance_to(device_.rig().now_ns() + duration_ns);
  }

 private:
  ComediStandIn device_;
  std::unique_ptr<Comedi> board_;
};

const RegisteredSubject kComedi{
    {"comedi", {"comedi"}, [](const auto& rig) { return std::make_unique<ComediSubject>(rig); }}};

}  // namespace
}  // namespace crane::bridge::test
