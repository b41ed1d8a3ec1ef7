/// No input crashes reader, mapping and loader: mutated files and small random data sets. CRANE_FUZZ_CASES
/// sets the number of cases, CRANE_FUZZ_SEED the first seed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>

#include "crane/diagnosis/data.hpp"
#include "crane/diagnosis/mapping.hpp"
#include "crane/diagnosis/replay.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

class Fuzz {
 public:
  explicit Fuzz(std::uint64_t seed) : random_(seed) {}

  std::string csv() {
    std::ostringstream text;
    std::vector<std::string> names{"time_s"};
    for (const char* name : {"trolley_voltage_v", "slew_voltage_v", "trolley_position_m", "slew_angle_rad",
                             "swing_radial_rad", "swing_tangential_rad", "cable_length_m"})
      if (below(4) != 0) names.emplace_back(name);
    for (std::size_t c = 0; c < names.size(); ++c) text << (c == 0 ? "" : ",") << names[c];
    text << '\n';
    const double step_s = std::pow(10, -4 + 3.2 * share()), wild = below(5) == 0 ? 1e3 : 1;
    const double jitter = below(2) == 0 ? 0 : share();
    double time_s = below(8) == 0 ? -1e9 * share() : 0;
    const std::size_t rows = below(6) == 0 ? below(20) : 100 + below(300);
    for (std::size_t row = 0; row < rows; ++row) {
      if (below(20) != 0 || row < 2) {
        text << time_s;
        for (std::size_t c = 1; c < names.size(); ++c) text << ',' << cell(names[c], time_s, wild);
        text << '\n';
      }
      time_s += step_s * (1 + jitter * (2 * share() - 1)) * (below(100) == 0 ? 300 : 1);
    }
    return text.str();
  }

  std::string mapping() {
    std::string text = below(3) == 0 ? "from_s = 0.1\n" : "";
    text +=
        "[columns]\ntime_s = { column = \"time_s\" }\nswing_radial_rad = { column = \"swing_radial_rad\", "
        "factor = 0.5, "
        "sign = -1, offset = 0.1, times = [\"cable_length_m\"] }\ntrolley_position_m = { value = 0.4 }\n";
    text += "trolley_voltage_v = { column = \"trolley_voltage_v\", unit = \"A\", per_volt = 2 }\n";
    text += "[enable]\ncolumn = \"slew_voltage_v\"\n[stretches]\n\"a.csv\" = [0.1, 0.9, 1.0, 3]\n";
    text += "[runs.\"a.csv\"]\ncable_length_m = 0.7\nload_mass_kg = 2\n";
    return text;
  }

  std::string mutated(std::string text) {
    static const std::vector<std::string> kTokens{
        "nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "",    ",",     "\n", "\"",    "=",
        "[",   "]",   "{",    "}",     "#",      "\r",     "1e7", "0x1p3", "-",  "time_s"};
    for (std::size_t n = below(6); n > 0 && !text.empty(); --n) {
      const std::size_t at = below(text.size()), length = std::min(text.size() - at, below(40));
      switch (below(6)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(below(text.size()), text.substr(at, length));
          break;
        case 3:
          text.insert(at, kTokens[below(kTokens.size())]);
          break;
        case 4:
          text.resize(at);
          break;
        default:
          replace_cell(text, at, kTokens[below(kTokens.size())]);
          break;
      }
    }
    return text;
  }

  std::size_t below(std::size_t n) { return random_() % n; }
  double share() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

 private:
  std::string cell(const std::string& name, double time_s, double wild) {
    if (below(60) == 0) return below(2) == 0 ? "" : "nan";
    if (below(5000) == 0) return "1e300";  // rare, because most files with such a value are refused
    const double wave = std::sin(2 * time_s + static_cast<double>(name.size()));
    const double value = name == "cable_length_m"                    ? 0.8 + 0.1 * wave
                         : name == "trolley_position_m"              ? 0.6 + 0.2 * wave
                         : name.find("voltage") != std::string::npos ? 2 * wave
                                                                     : 0.1 * wave;
    std::ostringstream text;
    text << wild * value;
    return text.str();
  }
  static void replace_cell(std::string& text, std::size_t at, const std::string& token) {
    const std::size_t begin = text.find(',', at),
                      end = begin == std::string::npos ? begin : text.find(',', begin + 1);
    if (end != std::string::npos) text.replace(begin + 1, end - begin - 1, token);
  }

  std::mt19937_64 random_;
};

/// The steps of the engine before its search.
void through_the_engine(const diagnosis::Run& run, const configuration::Rig& rig) {
  const Runs runs{prepare(run, rig)};
  const Replays replays = replays_of(runs, {rig.plant, rig.terms});
  for (const Part part : {Part::drive, Part::load}) {
    const Problem problem(runs, part, 2, 3);
    if (!problem.empty()) (void)problem.whitened_by(replays).fit(replays);
  }
}

TEST(DataFuzz, NoFileCrashesReaderMappingAndLoader) {
  const std::uint64_t cases = from_environment("CRANE_FUZZ_CASES", 2000),
                      seed = from_environment("CRANE_FUZZ_SEED", 1);
  RecordProperty("seed", std::to_string(seed));
  std::cout << "seed " << seed << ", " << cases << " cases\n";
  std::vector<configuration::Rig> rigs;
  for (const char* name : {"virginia_tech_tower", "gantry", "pendulum", "drive_axis"})
    rigs.push_back(configuration::load_rig(std::string{CRANE_RIGS} + "/" + name + ".toml"));
  std::size_t loaded = 0, refused = 0, simulated = 0;
  for (std::uint64_t k = 0; k < cases; ++k) {
    Fuzz fuzz(seed + k);
    const auto& rig = rigs[fuzz.below(rigs.size())];
    try {
      Mapping mapping;
      const bool mapped = fuzz.below(3) == 0;
      if (mapped) mapping = parse_mapping(fuzz.mutated(fuzz.mapping()), "a.toml");
      const std::string text = fuzz.below(3) == 0 ? fuzz.csv() : fuzz.mutated(fuzz.csv());
      const auto table = canonical(recording::parse_csv(text, "a.csv"), mapping, "a.csv");
      const Loaded data = load_run(table, rig, "a.csv");
      loaded += 1;
      for (const diagnosis::Run& run : data.runs)
        for (std::size_t row = 0; row < run.rows(); ++row)
          ASSERT_LE(std::abs(run.instant_s(row)), 1e9) << "case " << k;
      if (loaded % 10 == 0 && !data.runs.empty()) through_the_engine(data.runs[0], rig), ++simulated;
    } catch (const DataError&) {
      ++refused;
    } catch (const recording::CsvError&) {
      ++refused;
    } catch (const configuration::ConfigurationError&) {
      ++refused;
    }
  }
  std::cout << loaded << " loaded, " << refused << " refused, " << simulated << " simulated\n";
  EXPECT_EQ(loaded + refused, cases);
  if (cases >= 1000) {
    EXPECT_GT(loaded, cases / 50) << "most files have to reach the loader";
  }
}

}  // namespace
}  // namespace crane::diagnosis
