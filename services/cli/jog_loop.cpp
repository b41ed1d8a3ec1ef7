#include "cli/jog_loop.hpp"

#include <iostream>
#include <numbers>

#include "crane/plant/coordinates.hpp"
#include "crane/runtime/node.hpp"

namespace crane::cli {
namespace {

double seconds() { return static_cast<double>(runtime::monotonic_ns()) / 1e9; }

void print_axes(const char* what, const std::array<double, 3>& axes) {
  std::printf("%s trolley %+.1f mm, slew %+.3f deg, hoist %+.1f mm\n", what, axes[0] * 1e3,
              axes[1] * 180 / std::numbers::pi, axes[2] * 1e3);
  std::fflush(stdout);
}

std::array<double, 3> difference(const std::array<double, 3>& to, const std::array<double, 3>& from) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

}  // namespace

JogLoop::JogLoop(bus::Bus& bus, OperatorStick& stick, const JogLoopOptions& options)
    : bus_{bus}, stick_{stick}, options_{options}, session_{bus}, moves_{bus} {}

void JogLoop::read() {
  moves_.receive();
  if (moves_.take_interruption()) stop_point_.reset();
  stick_.read(seconds());
}

int JogLoop::run() {
  while (!stick_.quits() && stick_.problem().empty() && !runtime::stop_requested()) {
    read();
    const auto stick = stick_.deflection(seconds());
    const bool deflects = stick && *stick != Deflection{};
    if (!deflects) must_release_ = false;
    if (const auto step = stick_.take_step()) {
      inch(*step);
    } else if (stick_.take_return()) {
      go_back();
    } else if (!deflects || must_release_) {
      bus_.wait(std::chrono::milliseconds{20});
    } else if (!drive()) {
      return runtime::kExitFailed;
    }
  }
  if (!stick_.problem().empty()) throw std::runtime_error("jog: " + stick_.problem());
  return runtime::kExitDone;
}

bool JogLoop::drive() {
  if (const auto answer = session_.begin(options_.selected); !answer.accepted) {
    report("jog", answer);
    return false;
  }
  const auto stick = [this]() -> std::optional<Deflection> {
    read();
    if (!stick_.problem().empty()) return std::nullopt;
    const auto now = stick_.deflection(seconds());
    note_release(now);
    return now;
  };
  const auto over = [this] { return stick_.quits() || !stick_.problem().empty() || session_.in_hold(); };
  session_.drive(1e6, true, stick, over);
  must_release_ = deflected_;
  if (must_release_)
    std::cerr << "jog: the crane has stopped although the stick is deflected: release the stick\n";
  note_release(std::nullopt);
  session_.release(options_.timeout_s);
  moves_.receive();
  if (stop_point_ && moves_.measured())
    print_axes("at rest, HOLD; from the stop point:", difference(*moves_.measured(), *stop_point_));
  return true;
}

void JogLoop::note_release(const std::optional<Deflection>& stick) {
  const bool deflects = stick && *stick != Deflection{};
  if (deflected_ && !deflects) stop_point_ = moves_.measured();
  deflected_ = deflects;
}

bool JogLoop::execute(const char* what, const AxisTargets& targets) {
  (void)stick_.take_stop();
  return moves_.execute(what, targets, options_.timeout_s, [this]() -> std::string {
    read();
    (void)stick_.take_step();  // a step or return requested during a move is discarded
    (void)stick_.take_return();
    if (!stick_.problem().empty()) return stick_.problem();
    return stick_.take_stop() || stick_.quits() ? "stopped by the operator" : "";
  });
}

void JogLoop::inch(const InchingStep& step) {
  if (!options_.selected.at(step.axis)) {
    std::cerr << "inch: axis " << plant::kCoordinates.at(step.axis).name
              << " is not selected: add the axis to --axes\n";
    return;
  }
  constexpr double kPatience_s = 5;  // longest wait for the first samples
  const auto arrived = [this] {
    moves_.receive();
    return moves_.reference() && moves_.measured();
  };
  if (!wait_until(bus_, kPatience_s, arrived)) {
    std::cerr << "inch: no reference arrives: check with `crane status` that the stack runs\n";
    return;
  }
  const auto before = *moves_.measured();
  if (!execute("inch", inched(*moves_.reference(), step, options_.step_m))) return;
  print_axes("inch:", difference(*moves_.measured(), before));
}

void JogLoop::go_back() {
  if (!stop_point_ || !moves_.measured()) {
    std::cerr << "return: there is no stop point (a stop or a move by another client deletes it); deflect "
                 "and release the stick to set a new one\n";
    return;
  }
  if (!execute("return", back_to(*stop_point_, *moves_.measured(), options_.selected))) return;
  print_axes("return: from the stop point:", difference(*moves_.measured(), *stop_point_));
}

}  // namespace crane::cli
