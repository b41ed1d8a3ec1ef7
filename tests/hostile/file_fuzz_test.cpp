/// Mutated files: every reader of TOML and CSV accepts or refuses each text within bounded time and memory,
/// and each refusal names file and line. CRANE_FUZZ_SEED sets the first seed.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>

#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/diagnosis/mapping.hpp"
#include "crane/experiment/scenario.hpp"
#include "crane/recording/csv.hpp"
#include "file_mutator.hpp"
#include "sweep/sweep.hpp"

namespace crane::hostile {
namespace {

using std::chrono::milliseconds;

/// Processor time of one text. The time does not depend on the load of the computer; a reader that waits
/// without computing reaches the time limit of the test.
constexpr std::chrono::nanoseconds kLongest = std::chrono::seconds{1};
/// Peak of the whole test, with the memory of the address sanitizer (its quarantine keeps 256 MB). The
/// longest text has 1 MB.
constexpr long kMostMemory_kb = 1'000'000;

std::chrono::nanoseconds processor_time() {
  timespec used{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return std::chrono::seconds{used.tv_sec} + std::chrono::nanoseconds{used.tv_nsec};
}

std::uint64_t first_seed() {
  const char* text = std::getenv("CRANE_FUZZ_SEED");  // NOLINT(concurrency-mt-unsafe): one thread
  return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

/// Zones of a tower crane; the mutations may break the path of the base file.
constexpr const char* kZones = R"(extends = "virginia_tech_tower.toml"
name = "fuzz"
[clearance]
load_radius_m = 0.05
suspension_height_m = 2.0
[[zone]]
name = "silo"
shape = "cylinder"
position_x_m = 0.38
position_y_m = 0.59
radius_m = 0.12
top_m = 1.9
[[zone]]
name = "truck"
shape = "box"
position_x_m = 0.3
position_y_m = -0.75
size_x_m = 0.6
size_y_m = 0.3
top_m = 1.0
)";
constexpr const char* kScenario = R"(description = "fuzz"
duration_s = 30
controllers = ["gain_scheduling_partial", "delayed_1"]
[start]
trolley_position_m = 0.7
slew_angle_deg = 0
cable_length_m = 1.0
[[move]]
at_s = 0.5
trolley_position_m = 1.0
slew_angle_deg = 90
[[kick]]
at_s = 12.5
radial_degps = 30
tangential_degps = 20
)";
constexpr const char* kMapping = R"(from_s = 0.1
[columns]
time_s = { column = "t_s" }
swing_radial_rad = { column = "theta", factor = 0.5, sign = -1, offset = 0.1, times = ["l"] }
trolley_voltage_v = { column = "u", unit = "A", per_volt = 2 }
trolley_position_m = { value = 0.4 }
[enable]
column = "on"
[stretches]
"a.csv" = [0.1, 0.9, 1.0, 3]
[runs."a.csv"]
cable_length_m = 0.7
load_mass_kg = 2
)";
constexpr const char* kSweep = R"(description = "fuzz"
scenarios = ["maneuver_1"]
controllers = ["lqr"]
variants = ["as_is", "observer"]
integrator = "fast"
seeds = 100
[[draw]]
key = "plant.load_mass_kg"
low = 1.0
high = 3.0
)";
constexpr const char* kCsv = R"(# measured
time_s,trolley_voltage_v,swing_radial_rad
0,0,0.01
0.01,1.5,0.012
0.02,1.5,-0.013
)";

std::filesystem::path rig_file(const std::string& name) {
  return std::string{CRANE_RIGS} + "/" + name + ".toml";
}
std::filesystem::path scenario_file(const std::string& name) {
  return std::string{CRANE_SCENARIOS} + "/" + name + ".toml";
}

/// One reader of text.
struct Reader {
  const char* name;
  std::string text;
  Syntax syntax;
  std::uint64_t cases;
  std::function<void(const std::string&)> read;
};

std::vector<Reader> readers() {
  const auto rig = [](const std::string& text) {
    (void)configuration::parse_rig(text, CRANE_RIGS "/fuzz.toml");
  };
  return {{"rig", configuration::file_text(CRANE_RIGS "/drive_axis.toml"), Syntax::toml, 6'000, rig},
          {"zones", kZones, Syntax::toml, 1'500, rig},
          {"scenario", kScenario, Syntax::toml, 11'000,
           [](const auto& text) { (void)experiment::parse_scenario(text, "fuzz.toml"); }},
          {"mapping", kMapping, Syntax::toml, 11'000,
           [](const auto& text) { (void)diagnosis::parse_mapping(text, "fuzz.toml"); }},
          {"sweep", kSweep, Syntax::toml, 500,
           [](const auto& text) {
             (void)sweep::parse_sweep(text, "fuzz.toml", {rig_file, scenario_file});
           }},
          {"csv", kCsv, Syntax::csv, 70'000,
           [](const auto& text) { (void)recording::parse_csv(text, "fuzz.csv"); }}};
}

/// @return true when the line begins with "FILE:LINE: "
bool names_file_and_line(std::string_view line) {
  const auto suffix = std::min(line.find(".toml:"), line.find(".csv:"));
  if (suffix == std::string_view::npos) return false;
  const auto number = line.find(':', suffix) + 1;
  const auto end = line.find_first_not_of("0123456789", number);
  return end != std::string_view::npos && end > number && line.substr(end, 2) == ": ";
}

void expect_located(const std::string& what, const std::string& where) {
  for (std::size_t at = 0; at < what.size();) {
    const auto end = std::min(what.find('\n', at), what.size());
    ASSERT_TRUE(names_file_and_line(std::string_view{what}.substr(at, end - at)))
        << where << ": " << what.substr(at, end - at);
    at = end + 1;
  }
}

TEST(FileFuzz, EveryReaderRefusesOrAcceptsInBoundedTimeAndNamesTheLine) {
  const auto seed = first_seed();
  for (const auto& reader : readers()) {
    ASSERT_NO_THROW(reader.read(reader.text)) << reader.name << ": the text without mutations";
    std::uint64_t accepted = 0, refused = 0;
    std::chrono::nanoseconds longest{}, total{};
    std::string slowest;
    for (std::uint64_t k = 0; k < reader.cases; ++k) {
      const auto where = std::string{reader.name} + ", seed " + std::to_string(seed + k);
      const auto text = FileMutator{seed + k, reader.syntax}.mutated(reader.text);
      const auto begin = processor_time();
      try {
        reader.read(text);
        ++accepted;
      } catch (const configuration::ConfigurationError& error) {
        ++refused;
        ASSERT_NO_FATAL_FAILURE(expect_located(error.what(), where));
      } catch (const recording::CsvError& error) {
        ++refused;
        ASSERT_NO_FATAL_FAILURE(expect_located(error.what(), where));
      }
      const auto took = processor_time() - begin;
      total += took;
      if (took > longest) longest = took, slowest = where;
      ASSERT_LT(took, kLongest) << where;
    }
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    std::cout << reader.name << ": seeds " << seed << " to " << seed + reader.cases - 1 << ", " << accepted
              << " accepted, " << refused << " refused, "
              << std::chrono::duration_cast<milliseconds>(total).count() << " ms, longest "
              << std::chrono::duration_cast<milliseconds>(longest).count() << " ms (" << slowest << "), peak "
              << used.ru_maxrss / 1000 << " MB\n";
    EXPECT_LT(used.ru_maxrss, kMostMemory_kb);
    EXPECT_GT(accepted, reader.cases / 100) << "the mutations must keep some files correct";
    EXPECT_GT(refused, reader.cases / 10);
  }
}

}  // namespace
}  // namespace crane::hostile
