#pragma once
/// crane tune: from an unknown rig to a rig file that is ready to use.
///   1. probe      small motions of each axis: wiring, rough friction, rough cable length
///   2. motion     main motion of each axis
///   3. identify   cable length, rest angles, load mass; gain, friction and delay of each drive
///   4. recommend  law and gains, by simulated maneuvers on the identified rig
/// Files in the directory:
///   motion.csv   all motions one after the other, canonical columns; written after each motion
///   tune.json    estimates, ranking, recommendation; with "refused" when the tuning ends early
///   tuned.toml   the rig file
///   tune.html    the report
/// A tuning that ends early does not change tuned.toml and tune.html of an earlier tuning.
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "tuning/crane_access.hpp"
#include "tuning/identify.hpp"
#include "tuning/recommend.hpp"

namespace crane::report {
struct Page;
}

namespace crane::tuning {

inline constexpr const char* kMotionFile = "motion.csv";
inline constexpr const char* kJsonFile = "tune.json";
inline constexpr const char* kRigFile = "tuned.toml";
inline constexpr const char* kMotionRigFile = "motion_rig.toml";  ///< of RealtimeCrane
inline constexpr const char* kPageFile = "tune.html";

/// The tuning ends without a result. what() names the reasons and the files written so far.
class TuningRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct TuneOptions {
  std::filesystem::path directory;              ///< created when missing
  std::vector<std::filesystem::path> inputs{};  ///< files that must not be replaced, besides the rig file
  Priors priors{};
  std::vector<std::filesystem::path> maneuvers{};            ///< scenario files
  std::vector<Candidate> candidates = tuning::candidates();  ///< compared laws and gains
  unsigned processors = 1;
  bool recommend = true;   ///< false: identification only
  std::uint64_t seed = 1;  ///< seed of the drawn rigs; tune.json contains it
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

struct TuneResult {
  configuration::Rig tuned;  ///< rig file with identified values, law and gains
  Identification identification;
  Recommendation recommendation;
  double motion_s = 0;                     ///< total duration of all motions
  std::vector<std::string> differences{};  ///< Motion::differences of all motions
  std::uint64_t seed = 1;                  ///< seed of the drawn rigs
};

/// @throws TuningRefused, configuration::ConfigurationError for a rig that cannot be tuned, and exceptions of
///   the crane
[[nodiscard]] TuneResult tune(const configuration::Rig& rig, CraneAccess& crane, const TuneOptions& options);

[[nodiscard]] nlohmann::ordered_json to_json(const TuneResult& result, const configuration::Rig& rig);
/// Text of tuned.toml: the tuned rig, with the standard errors as comments.
[[nodiscard]] std::string rig_text(const TuneResult& result);
[[nodiscard]] report::Page page_of(const TuneResult& result, const configuration::Rig& rig,
                                   const recording::Table& motion);

}  // namespace crane::tuning
