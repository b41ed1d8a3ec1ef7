#include "vendor_log.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "crane/fields/printable.hpp"

namespace crane::bus {

void vendor_log(std::string_view vendor, std::string_view line) noexcept {
  constexpr int kMostLines = 20;  // number of lines of kMostBytes; all lines fit into the buffer of a pipe
                                  // (64 kB), so that no write blocks
  constexpr std::size_t kMostBytes = 500;
  constexpr std::string_view kLast = " (further messages of this kind are dropped)";
  static std::atomic<int> lines{0};
  const int number = ++lines;
  if (number > kMostLines) {
    lines = kMostLines;
    return;
  }
  std::array<char, kMostBytes + kLast.size() + 32> text{};
  auto* end = text.data();
  const auto put = [&end](std::string_view part) { end = std::copy(part.begin(), part.end(), end); };
  while (!line.empty() && line.back() == '\n') line.remove_suffix(1);
  put(vendor.substr(0, 16));
  put(": ");
  put(line.substr(0, kMostBytes));
  if (number == kMostLines) put(kLast);
  fields::make_printable(
      {text.data(), static_cast<std::size_t>(
                        end - text.data())});  // the line may contain names that other programs have chosen
  put("\n");
  (void)!::write(STDERR_FILENO, text.data(), static_cast<std::size_t>(end - text.data()));
}

}  // namespace crane::bus
