#pragma once
#include <ostream>

namespace crane::hostile {

/// The processes of the loop on the simulated plant.
inline constexpr const char* kLoop[] = {"plant",      "trajectory_planner",    "tracking",
                                        "anti_swing", "friction_compensation", "supervisor"};

/// Each loop topic and a process that reads it.
struct LoopRoute {
  const char* topic;
  const char* reader;
};
inline std::ostream& operator<<(std::ostream& out, const LoopRoute& route) {
  return out << route.topic << " to " << route.reader;
}
inline constexpr LoopRoute kLoopRoutes[] = {{"command", "plant"},
                                            {"state", "supervisor"},
                                            {"reference", "tracking"},
                                            {"tracking", "friction_compensation"},
                                            {"anti_swing", "friction_compensation"},
                                            {"demand", "supervisor"},
                                            {"supervisor", "trajectory_planner"}};

}  // namespace crane::hostile
