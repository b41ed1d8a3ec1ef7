#pragma once

namespace crane::hostile {

/// The processes of the loop on the simulated plant.
inline constexpr const char* kLoop[] = {"plant",      "trajectory_planner",    "tracking",
                                        "anti_swing", "friction_compensation", "supervisor"};

}  // namespace crane::hostile
