#pragma once
/// Measured data of a crane with hidden effects, and the sealed answer. For tests and benchmarks of the
/// diagnosis. The equations of motion, integrator, friction, controller and sensors share no code with the
/// libraries of the project. The form of the effects differs from that of the library.
///
/// Row k of a run holds the measurement at t_k and the command applied from t_k on. The controller of tick k
/// acts at t_{k+1}.
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace truth {

/// One hidden effect. Empty axis: the seed selects a suitable axis. `amplitude` is a multiple of the size
/// that is clearly visible above the disturbance (effect_kinds()); 0 switches the effect off. If both signs
/// are possible, the seed selects the sign; a negative amplitude selects the negative sign.
struct Hidden {
  std::string name;
  double amplitude = 1;
  std::string axis;
};

struct Case {
  std::string rig = "tower";
  std::vector<Hidden> effects;
  std::uint64_t seed = 1;
  std::vector<std::string> training_runs{"rich", "moves"};
  std::vector<std::string> test_runs{"rich"};
  double seconds = 0;        ///< of every run; 0: the run's usual length, 30 to 50 s
  double disturbance = 1;    ///< multiple of the usual disturbance, whose size depends on the seed
  bool sensor_noise = true;  ///< noise and rounding of encoders and converter
};

struct Run {
  std::string kind;
  std::string file;                       ///< name without extension: train_1, test_1
  std::vector<std::string> columns;       ///< canonical names, time_s first
  std::vector<std::vector<double>> rows;  ///< one per tick, values in the order of `columns`
};

struct Value {
  std::string name;
  double value = 0;
  std::string unit;
};

/// A hidden effect of the answer.
struct Found {
  std::string name, axis;
  double amplitude = 0;
  bool in_library = true;  ///< false: the correct verdict is "unknown"
  std::string form;        ///< description of the simulated effect
  std::vector<Value> parameters;
};

struct Data {
  Case request;
  std::vector<Run> training, test;
  std::vector<Found> answer;
};

/// @throws std::invalid_argument that names an unknown rig, effect, axis or run, or one that the rig cannot
/// have
[[nodiscard]] Data generate(const Case& request);

/// Visibility of the effects: over windows of two seconds that begin in the true state, the deviation of a
/// crane without the effects, and the deviation of a crane without the disturbance.
struct Size {
  std::array<double, 4> effect{}, disturbance{};  ///< rms: trolley m, slew rad, radial rad, tangential rad
  double ratio = 0;                               ///< largest effect / disturbance of the columns
};
[[nodiscard]] Size effect_size(const Case& request);

[[nodiscard]] std::string csv(const Run& run);
[[nodiscard]] std::string answer_json(const Data& data);
/// Writes train_N.csv, test_N.csv and answer.json; creates the directory. @throws std::runtime_error
void write(const Data& data, const std::filesystem::path& directory);

struct EffectKind {
  std::string name;
  std::vector<std::string> axes;  ///< {""} for an effect without an axis
  bool in_library = true;
  std::string form;
};
[[nodiscard]] const std::vector<EffectKind>& effect_kinds();
[[nodiscard]] const std::vector<std::string>& run_kinds();

}  // namespace truth
