#pragma once
/// List of the possible faults, with the names of `crane diagnose` if such a name exists.
#include <map>
#include <string>
#include <vector>

#include "chance.hpp"
#include "physics.hpp"

namespace mujoco_truth {

/// One fault with an amount that can be scaled.
struct Fault {
  std::string name, axis;
  bool in_library = true;
  double amount = 0;                    ///< in the unit of its first parameter
  std::map<std::string, double> shape;  ///< drawn once: wavelengths, directions, times
  /// Correct report of `crane diagnose`, with its names, units and signs.
  [[nodiscard]] std::map<std::string, double> parameters() const;
};

/// Requirements of a rig for a fault that is visible in its data.
enum class Where {
  drive,         ///< any drive
  tower_drive,   ///< a drive of a tower, which has a second drive
  loaded_drive,  ///< a drive that moves a load
  load,          ///< any load
  driven_load,  ///< a load that a drive moves; on a free pendulum the fault is equivalent to another start or
                ///< another zero
  tower,        ///< a tower
  swing         ///< a swing sensor
};

struct FaultKind {
  /// Receives the numbers of a fault.
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
  /// trial and largest amount, as multiples of the scale of the rig: weight, length, friction
  double trial, most;
  const char* parameter;  ///< parameter of `crane diagnose` that the amount changes
  double without;         ///< value of this parameter without the fault
  void (*apply)(const Target&);
};

/// Number of occurrences per minute of an intermittent fault.
inline constexpr int kStretches = 8;

[[nodiscard]] const std::vector<FaultKind>& fault_kinds();
[[nodiscard]] const FaultKind& kind_of(const Fault& fault);
/// Axes of the rig on which the fault is possible and visible in the data; {""} for a fault without an axis.
[[nodiscard]] std::vector<std::string> axes_of(const FaultKind& kind, const Rig& rig);
/// The fault with a shape, the trial amount and a sign.
[[nodiscard]] Fault drawn_fault(const FaultKind& kind, const std::string& axis, const Rig& rig,
                                Chance& chance);
/// The largest amount with which the crane can still be operated.
[[nodiscard]] double most_of(const Fault& fault, const Rig& rig);
[[nodiscard]] Physics with(Physics physics, const std::vector<Fault>& faults);

/// Groups of causes that one experiment cannot distinguish (docs/diagnosis.md, Causes).
[[nodiscard]] bool confounded(const std::string& a, const std::string& b);

}  // namespace mujoco_truth
