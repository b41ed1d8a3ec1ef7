#include "grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace crane::control {
namespace {

constexpr int kMostNodes = 8000;     // bounds time and memory of a search
constexpr double kSpacing_m = 0.04;  // smallest distance of neighbouring nodes over the ground
constexpr int kEndCells = 2;         // candidates for neighbours of start and target: nodes on each side
constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Evenly spaced values of one axis.
struct Nodes {
  double low = 0, step = 0;
  int count = 1;
  [[nodiscard]] double at(int i) const noexcept { return low + step * i; }
  [[nodiscard]] int nearest(double value) const noexcept {
    if (!(step > 0)) return 0;
    return static_cast<int>(std::lround(std::clamp((value - low) / step, 0.0, count - 1.0)));
  }
};

Nodes nodes_of(const PathSpace::Axis& axis, double fixed, double spacing) noexcept {
  if (!axis.present || !(axis.high > axis.low)) return {.low = fixed};
  const int cells = std::max(1, static_cast<int>(std::ceil((axis.high - axis.low) / spacing)));
  return {.low = axis.low, .step = (axis.high - axis.low) / cells, .count = cells + 1};
}

class Grid {
 public:
  Grid(const PathSpace& space, const PerAxis& from, const PerAxis& to, std::vector<char>& blocking)
      : space_{space}, from_{from}, to_{to}, blocking_{blocking} {
    const auto &trolley = space.axis[kTrolley], &slew = space.axis[kSlew];
    const double radius_m = std::max({std::abs(trolley.low), std::abs(trolley.high), 0.1});
    double spacing_m = kSpacing_m;
    do {
      trolley_ = nodes_of(trolley, from[kTrolley], spacing_m);
      slew_ = nodes_of(slew, from[kSlew], spacing_m / radius_m);
      spacing_m *= 1.1;
    } while (static_cast<double>(trolley_.count) * slew_.count > kMostNodes);
    target_ = trolley_.count * slew_.count;
    const auto nodes = static_cast<std::size_t>(target_) + 1;
    gap_.resize(nodes, ClosestZone{.clearance_m = std::numeric_limits<double>::quiet_NaN()});
    cost_s_.resize(nodes, kUnreached);
    parent_.resize(nodes, kFromStart);
    done_.resize(nodes, 0);
    to_target_s_.resize(nodes, kUnreached);
    pass_mps_.resize(nodes, 0);
    for (int i = 0; i < trolley_.count; ++i) {
      const PerAxis at = place(i);
      for (int across = 0; across < 2; ++across)
        for (int up = 0; up < 2; ++up) {
          PerAxis next = at;
          next[kTrolley] += up * trolley_.step, next[kSlew] += across * slew_.step;
          edges_.push_back({cruise_time_s(space, at, next, 1), ground_distance_m(at, next)});
        }
    }
  }

  std::optional<std::vector<PerAxis>> search() {
    begin();
    while (!open_.empty()) {
      const auto [estimate_s, node] = open_.top();
      open_.pop();
      if (done_[index(node)] != 0) continue;
      done_[index(node)] = 1;
      if (node == target_) return nodes_to_target();
      expand(node);
    }
    return std::nullopt;
  }

 private:
  static constexpr int kFromStart = -1;
  using Open = std::pair<double, int>;  // estimated duration of the whole path, node; of equal durations the
                                        // smaller node is first

  static std::size_t index(int node) noexcept { return static_cast<std::size_t>(node); }
  [[nodiscard]] PerAxis place(int node) const noexcept {
    return {trolley_.at(node % trolley_.count), slew_.at(node / trolley_.count), from_[kHoist]};
  }
  const ClosestZone& gap(int node) noexcept {
    auto& gap = gap_[index(node)];
    if (std::isnan(gap.clearance_m)) {
      gap = closest_zone(space_, place(node));
      pass_mps_[index(node)] = passing_speed_mps(space_, gap.clearance_m, from_[kHoist]);
    }
    return gap;
  }
  bool is_open(int node) noexcept {
    const auto& here = gap(node);
    if (here.clearance_m >= kPassClearance_m) return true;
    blocking_[here.zone] = 1;
    return false;
  }

  void begin() {
    for_each_near(from_, [&](int node) {
      const Leg leg = end_leg(space_, from_, place(node));
      if (leg.is_free)
        relax(node, kFromStart, leg.duration_s);
      else
        blocking_[leg.zone] = 1;
    });
    for_each_near(to_, [&](int node) {
      const Leg leg = end_leg(space_, place(node), to_);
      if (leg.is_free)
        to_target_s_[index(node)] = leg.duration_s;
      else
        blocking_[leg.zone] = 1;
    });
  }
  template <typename Visit>
  void for_each_near(const PerAxis& end, Visit visit) {
    const int column = trolley_.nearest(end[kTrolley]), row = slew_.nearest(end[kSlew]);
    for (int k = std::max(0, row - kEndCells); k <= std::min(slew_.count - 1, row + kEndCells); ++k)
      for (int i = std::max(0, column - kEndCells); i <= std::min(trolley_.count - 1, column + kEndCells);
           ++i)
        if (const int node = k * trolley_.count + i; is_open(node)) visit(node);
  }

  void relax(int node, int parent, double cost_s) {
    if (cost_s >= cost_s_[index(node)]) return;
    cost_s_[index(node)] = cost_s;
    parent_[index(node)] = parent;
    open_.emplace(cost_s + (node == target_ ? 0 : cruise_time_s(space_, place(node), to_, 1)), node);
  }

  void expand(int node) {
    const int column = node % trolley_.count, row = node / trolley_.count;
    if (to_target_s_[index(node)] < kUnreached)
      relax(target_, node, cost_s_[index(node)] + to_target_s_[index(node)]);
    for (int k = std::max(0, row - 1); k <= std::min(slew_.count - 1, row + 1); ++k)
      for (int i = std::max(0, column - 1); i <= std::min(trolley_.count - 1, column + 1); ++i) {
        const int next = k * trolley_.count + i;
        if (next == node || done_[index(next)] != 0 || !is_open(next)) continue;
        const Edge& edge =
            edges_[4 * index(std::min(column, i)) + (k != row ? 2U : 0U) + (i != column ? 1U : 0U)];
        if (!is_free(node, next, edge.distance_m)) continue;
        const double speed_mps = std::min(pass_mps_[index(node)], pass_mps_[index(next)]);
        relax(next, node, cost_s_[index(node)] + std::max(edge.full_s, edge.distance_m / speed_mps));
      }
  }

  bool is_free(int node, int next, double distance_m) {
    if ((gap(node).clearance_m + gap(next).clearance_m - distance_m) / 2 >= kPassClearance_m) return true;
    const Leg leg = leg_of(space_, place(node), place(next), kPassClearance_m);
    if (!leg.is_free) blocking_[leg.zone] = 1;
    return leg.is_free;
  }

  [[nodiscard]] std::vector<PerAxis> nodes_to_target() const {
    std::vector<PerAxis> places{to_};
    for (int node = parent_[index(target_)]; node != kFromStart; node = parent_[index(node)])
      places.push_back(place(node));
    places.push_back(from_);
    std::ranges::reverse(places);
    return places;
  }

  const PathSpace& space_;
  PerAxis from_, to_;
  std::vector<char>& blocking_;
  Nodes trolley_, slew_;
  int target_ = 0;  ///< node after those of the grid
  std::vector<ClosestZone> gap_;
  std::vector<double> cost_s_, to_target_s_, pass_mps_;
  struct Edge {
    double full_s, distance_m;  ///< time at the reference speeds, distance over the ground
  };
  std::vector<Edge> edges_;  ///< by the column of its inner end, then: none, trolley, slew, both
  std::vector<int> parent_;
  std::vector<char> done_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace

Leg end_leg(const PathSpace& space, const PerAxis& from, const PerAxis& to) {
  Leg leg = leg_of(space, from, to, kRestClearance_m);
  if (leg.is_free || closest_zone(space, from).clearance_m >= kRestClearance_m) return leg;
  leg.is_free =
      zone_in_path(space.zones, space.clearance, space.gravity_mps2, from, to, kRestClearance_m) == nullptr;
  leg.speed_share = speed_share(space, from, to, 0);
  leg.duration_s = cruise_time_s(space, from, to, leg.speed_share);
  return leg;
}

std::optional<std::vector<PerAxis>> search_grid(const PathSpace& space, const PerAxis& from,
                                                const PerAxis& to, std::vector<char>& blocking) {
  return Grid{space, from, to, blocking}.search();
}

}  // namespace crane::control
