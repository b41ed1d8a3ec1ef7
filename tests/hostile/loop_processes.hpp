#pragma once
#include <array>
#include <ostream>
#include <vector>

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

/// Loop topics with a vendor: crane/command with both, each other topic with one in turn; or all other pairs.
/// @tparam Route initialised from topic, reader, vendor
template <class Route>
std::vector<Route> routes_in_turn(bool usual) {
  constexpr std::array kVendors{"cyclone", "fastdds"};
  std::vector<Route> chosen;
  for (std::size_t vendor = 0; vendor < kVendors.size(); ++vendor)
    for (std::size_t topic = 0; topic < std::size(kLoopRoutes); ++topic)
      if ((topic == 0 || (topic + vendor) % kVendors.size() == 0) == usual)
        chosen.push_back({kLoopRoutes[topic].topic, kLoopRoutes[topic].reader, kVendors[vendor]});
  return chosen;
}

}  // namespace crane::hostile
