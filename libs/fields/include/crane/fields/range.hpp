#pragma once
#include <limits>
#include <string>

namespace crane::fields {

/// Interval of allowed finite numbers.
struct Range {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low = -kInfinity;
  double high = kInfinity;
  bool low_included = true;
  bool high_included = true;

  static constexpr Range any() { return {}; }
  static constexpr Range positive() { return {0, kInfinity, false, true}; }
  static constexpr Range not_negative() { return {0, kInfinity, true, true}; }
  static constexpr Range closed(double low, double high) { return {low, high, true, true}; }  ///< [low, high]
  static constexpr Range above(double low, double high) { return {low, high, false, true}; }  ///< (low, high]
  static constexpr Range open(double low, double high) { return {low, high, false, false}; }  ///< (low, high)

  /// False for NaN and infinities.
  [[nodiscard]] bool contains(double value) const;
  /// "[0, 10]", "(0, 10]", "> 0"; empty for a range without bounds
  [[nodiscard]] std::string interval() const;
  /// "must be finite and > 0", "must be in (0, 10]", ...
  [[nodiscard]] std::string rule() const;
};

/// "name = value: rule", the form of every message about a wrong number.
[[nodiscard]] std::string complaint(const std::string& name, double value, const std::string& rule);

}  // namespace crane::fields
