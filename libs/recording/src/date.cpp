#include "date.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <string>

namespace crane::recording {
namespace {

/// Reads a text from its beginning. After the first part that does not fit, `fits` is false.
class Reader {
 public:
  explicit Reader(std::string_view text) : left_{text} {}

  /// The next `digits` digits, a number up to `most`.
  int number(std::size_t digits, int most) {
    int value = 0;
    const std::string_view part = left_.substr(0, digits);
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    fits_ = fits_ && error == std::errc{} && part.size() == digits && end == part.data() + digits &&
            part.front() != '-' && value <= most;
    left_.remove_prefix(part.size());
    return value;
  }
  /// Removes the next character if it is one of these. @return the character, or 0
  char one_of(std::string_view characters) {
    if (left_.empty() || characters.find(left_.front()) == std::string_view::npos) return 0;
    const char found = left_.front();
    left_.remove_prefix(1);
    return found;
  }
  void require(std::string_view characters) { fits_ = one_of(characters) != 0 && fits_; }
  /// The digits of a fraction, as a part of one second.
  double fraction() {
    const std::size_t digits = std::min(left_.find_first_not_of("0123456789"), left_.size());
    const std::string text = "0." + std::string{left_.substr(0, digits)};
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    fits_ = fits_ && digits > 0;
    left_.remove_prefix(digits);
    return value;
  }
  [[nodiscard]] bool fits() const { return fits_; }
  [[nodiscard]] bool at_end() const { return left_.empty(); }

 private:
  std::string_view left_;
  bool fits_ = true;
};

}  // namespace

std::optional<double> seconds_of_date(std::string_view text) {
  Reader reader{text};
  const int year = reader.number(4, 9999);
  reader.require("-");
  const int month = reader.number(2, 12);
  reader.require("-");
  const int day = reader.number(2, 31);
  reader.require("T ");
  const int hour = reader.number(2, 23);
  reader.require(":");
  const int minute = reader.number(2, 59);
  reader.require(":");
  const int second = reader.number(2, 60);
  const double fraction = reader.one_of(".,") != 0 ? reader.fraction() : 0;
  int offset_min = 0;
  if (const char sign = reader.one_of("Z+-"); sign == '+' || sign == '-') {
    const int hours = reader.number(2, 23);
    (void)reader.one_of(":");
    offset_min = (sign == '+' ? 1 : -1) * (60 * hours + (reader.at_end() ? 0 : reader.number(2, 59)));
  }
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  if (!reader.fits() || !reader.at_end() || !date.ok()) return std::nullopt;
  const auto days = std::chrono::sys_days{date}.time_since_epoch();
  const double minutes = 60.0 * hour + minute - offset_min;
  return 86400.0 * static_cast<double>(days.count()) + 60 * minutes + second + fraction;
}

}  // namespace crane::recording
