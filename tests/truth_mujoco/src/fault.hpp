#pragma once
/// The list of what can be wrong, under the names of `crane diagnose` where it has one.
#include <map>
#include <string>
#include <vector>

#include "chance.hpp"
#include "physics.hpp"

namespace mujoco_truth {

/// One thing that is wrong, of an amount that can be scaled.
struct Fault {
  std::string name, axis;
  bool in_library = true;
  double amount = 0;                    ///< in the unit of its first parameter
  std::map<std::string, double> shape;  ///< drawn once: wavelengths, directions, times
  /// What `crane diagnose` should report: its names, units and signs.
  [[nodiscard]] std::map<std::string, double> parameters() const;
};

/// What a rig must have for the fault to be there, and to show in its data.
enum class Where {
  drive,         ///< any drive
  tower_drive,   ///< a drive of a tower, which has another one
  loaded_drive,  ///< a drive that moves a load
  load,          ///< any load
  driven_load,   ///< a load that a drive moves: on a free pendulum it is another start or another zero
  tower,         ///< a tower
  swing          ///< either swing sensor
};

struct FaultKind {
  /// Where the numbers of a fault go.
  class Target {
   public:
    Target(Physics& physics, const Fault& fault) : physics_(physics), fault_(fault) {}
    [[nodiscard]] std::size_t axis() const { return fault_.axis == "slew" ? kSlew : kTrolley; }
    [[nodiscard]] std::size_t swing() const { return fault_.axis == "tangential" ? kTangential : kRadial; }
    [[nodiscard]] double amount() const { return fault_.amount; }
    [[nodiscard]] double operator[](const std::string& shape) const { return fault_.shape.at(shape); }
    [[nodiscard]] DriveFault& drive() const { return physics_.drive[axis()]; }
    [[nodiscard]] LoadFault& load() const { return physics_.load; }
    [[nodiscard]] SensorFault& sensor() const { return physics_.sensor; }

   private:
    Physics& physics_;
    const Fault& fault_;
  };

  const char* name;
  Where where;
  bool in_library, both_signs;
  double trial, most;     ///< amounts, times the rig's own scale: weight, length, friction
  const char* parameter;  ///< of `crane diagnose`, that the amount changes
  double without;         ///< its value without the fault
  void (*apply)(const Target&);
};

/// How often something comes and goes in a minute.
inline constexpr int kStretches = 8;

[[nodiscard]] const std::vector<FaultKind>& fault_kinds();
[[nodiscard]] const FaultKind& kind_of(const Fault& fault);
/// Axes of the rig on which the fault can be and would show in data; {""} for a fault without an axis.
[[nodiscard]] std::vector<std::string> axes_of(const FaultKind& kind, const Rig& rig);
/// With a shape, at the trial amount and with a sign.
[[nodiscard]] Fault drawn_fault(const FaultKind& kind, const std::string& axis, const Rig& rig,
                                Chance& chance);
/// The largest amount of it that leaves the crane a crane.
[[nodiscard]] double most_of(const Fault& fault, const Rig& rig);
[[nodiscard]] Physics with(Physics physics, const std::vector<Fault>& faults);

/// Causes that are one until something else changes (docs/diagnosis.md, Limits).
[[nodiscard]] bool confounded(const std::string& a, const std::string& b);

}  // namespace mujoco_truth
