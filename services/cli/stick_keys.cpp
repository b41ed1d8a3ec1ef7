#include "cli/stick_keys.hpp"

#include <algorithm>
#include <limits>

namespace crane::cli {
namespace {

struct Sequence {
  std::string_view bytes;
  std::size_t axis;
  double share;
};
/// Escape sequences of xterm: arrow and page keys, without and with shift.
constexpr std::array kSequences{Sequence{"\x1b[A", 0, 1},
                                Sequence{"\x1b[B", 0, -1},
                                Sequence{"\x1b[C", 1, 1},
                                Sequence{"\x1b[D", 1, -1},
                                Sequence{"\x1b[5~", 2, -1},
                                Sequence{"\x1b[6~", 2, 1},
                                Sequence{"\x1bOA", 0, 1},
                                Sequence{"\x1bOB", 0, -1},
                                Sequence{"\x1bOC", 1, 1},
                                Sequence{"\x1bOD", 1, -1},
                                Sequence{"\x1b[1;2A", 0, kMicroSpeed},
                                Sequence{"\x1b[1;2B", 0, -kMicroSpeed},
                                Sequence{"\x1b[1;2C", 1, kMicroSpeed},
                                Sequence{"\x1b[1;2D", 1, -kMicroSpeed},
                                Sequence{"\x1b[5;2~", 2, -kMicroSpeed},
                                Sequence{"\x1b[6;2~", 2, kMicroSpeed}};

}  // namespace

void StickKeys::press(std::size_t axis, double share, double now_s) {
  if (!keys_move_) return;
  Key& key = key_[axis];
  const bool repeats = key.share == share && now_s <= key.until_s;
  // A slow connection delays single repetitions: a step too few is better than a step too many.
  key = {share, now_s + (repeats && !inching_ ? kRepeat_s : kFirst_s)};
  last_s_ = now_s;
  if (inching_ && !repeats) step_ = InchingStep{.axis = axis, .direction = share < 0 ? -1 : 1};
}

void StickKeys::release() {
  key_ = {};
  step_.reset();
  last_s_ = -1;
}

void StickKeys::take_letter(char letter) {
  switch (letter) {
    case ' ':
      release();
      released_ = true;
      break;
    case 'q':
      quits_ = true;
      break;
    case 'm':
      micro_ = !micro_;
      break;
    case 'i':  // a key that was pressed before the change of mode must not act after the change
      release();
      inching_ = !inching_;
      break;
    case 'r':
      release();
      returns_ = keys_move_;
      break;
    default:
      break;
  }
}

/// Takes one key from the front. @return false when the bytes are the beginning of a sequence
bool StickKeys::take_sequence(double now_s) {
  if (pending_.front() == '\x1b') {
    bool begins = false;
    for (const auto& [bytes, axis, share] : kSequences) {
      if (pending_.starts_with(bytes)) {
        press(axis, share, now_s);
        pending_.erase(0, bytes.size());
        return true;
      }
      begins = begins || bytes.starts_with(pending_);
    }
    if (begins) return false;
  } else {
    take_letter(pending_.front());
  }
  pending_.erase(0, 1);
  return true;
}

void StickKeys::take(std::string_view bytes, double now_s) {
  pending_ += bytes;
  while (!pending_.empty() && take_sequence(now_s)) continue;
}

void StickKeys::take_pass(std::string_view bytes, double now_s) {
  const double arrived_s =
      std::exchange(previous_pass_s_, now_s).value_or(-std::numeric_limits<double>::infinity());
  const bool backlog = now_s - arrived_s > kFirst_s || bytes.size() > kMostNewBytes;
  if (backlog && !bytes.empty()) backlog_until_s_ = now_s + kRepeat_s;
  const bool stops = bytes.find_first_of(" q") != std::string_view::npos;
  keys_move_ = !backlog && !stops && now_s >= backlog_until_s_;
  take(bytes, arrived_s);
  if (!keys_move_) pending_.clear();
  keys_move_ = true;
}

std::array<double, 3> StickKeys::deflection(double now_s) const {
  std::array<double, 3> result{};
  if (inching_) return result;
  for (std::size_t i = 0; i < key_.size(); ++i) {
    if (now_s > key_[i].until_s) continue;
    result[i] = micro_ ? std::clamp(key_[i].share, -kMicroSpeed, kMicroSpeed) : key_[i].share;
  }
  return result;
}

}  // namespace crane::cli
