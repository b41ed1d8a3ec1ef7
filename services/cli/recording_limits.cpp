#include "cli/recording_limits.hpp"

#include <algorithm>
#include <optional>

#include "cli/units.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::cli {
namespace {

/// With a quota and no size of the parts, a part is a tenth of the quota.
constexpr std::uint64_t kPartsOfQuota = 10;
/// Shorter parts would consist mostly of types and index.
constexpr double kShortestPart_s = 1;
constexpr double kLongestPart_s = 3.2e9;  // 100 years

/// Collects the problems of all options.
class Values {
 public:
  template <class Parse>
  auto value(const char* option, const std::string& text, const Parse& parse)
      -> std::optional<decltype(parse(text))> {
    if (text.empty()) return std::nullopt;
    try {
      return parse(text);
    } catch (const UnitError& error) {
      problem(std::string{option} + ": " + error.what());
      return std::nullopt;
    }
  }
  void problem(std::string what) { problems_.push_back(std::move(what)); }
  void finish() const {
    if (!problems_.empty()) throw configuration::ConfigurationError(problems_);
  }

 private:
  std::vector<std::string> problems_;
};

}  // namespace

void add_limit_options(CLI::App& command, LimitOptions& options, const std::string& prefix) {
  command
      .add_option(prefix + "split-size", options.split_size,
                  "begin a new part before a file exceeds this size (500MB, 1GiB; at least 1MB)")
      ->type_name("SIZE");
  command
      .add_option(prefix + "split-every", options.split_every,
                  "begin a new part after this time (10min, 1h, 30s; at least 1s)")
      ->type_name("TIME");
  command
      .add_option(
          prefix + "quota", options.quota,
          "delete the oldest parts of this recording before all parts together exceed this size; at least "
          "twice the size of a part; default size of a part: a tenth of this size, at least 1MB")
      ->type_name("SIZE");
}

std::vector<std::string> arguments(const LimitOptions& options) {
  std::vector<std::string> list;
  const auto add = [&list](const char* option, const std::string& text) {
    if (text.empty()) return;
    list.emplace_back(option);
    list.push_back(text);
  };
  add("--split-size", options.split_size);
  add("--split-every", options.split_every);
  add("--quota", options.quota);
  return list;
}

recorder::Limits limits_of(const LimitOptions& options) {
  Values values;
  const auto size = values.value("--split-size", options.split_size, parse_bytes);
  const auto every_s = values.value("--split-every", options.split_every, parse_duration);
  const auto quota = values.value("--quota", options.quota, parse_bytes);
  if (size && *size < recorder::kSmallestPart_bytes)
    values.problem("--split-size: '" + options.split_size + "' is less than 1MB, the smallest part");
  if (every_s && *every_s < kShortestPart_s)
    values.problem("--split-every: '" + options.split_every + "' is less than 1s, the shortest part");
  recorder::Limits limits;
  limits.part_bytes = size.value_or(0);
  if (every_s)
    limits.part =
        std::chrono::nanoseconds{static_cast<std::int64_t>(std::min(*every_s, kLongestPart_s) * 1e9)};
  if (quota) {
    limits.quota_bytes = *quota;
    if (options.split_size.empty())
      limits.part_bytes = std::max(*quota / kPartsOfQuota, recorder::kSmallestPart_bytes);
    if (*quota < 2 * limits.part_bytes)
      values.problem("--quota: '" + options.quota + "' has no room for two parts of " +
                     std::to_string(limits.part_bytes) + " bytes: the recording would lose all past samples");
  }
  values.finish();
  return limits;
}

}  // namespace crane::cli
