/// The table of controllers, made from laws/registered.def.
#include <algorithm>

#include "crane/control/fuzzy.hpp"
#include "crane/control/law.hpp"

namespace crane::control {

#define CRANE_CONTROLLER(name, summary, shape, tracking, anti_swing, corrects) \
  std::unique_ptr<Law> tracking(const Design& design);                         \
  std::unique_ptr<Law> anti_swing(const Design& design);
#include "laws/registered.def"
#undef CRANE_CONTROLLER

const std::vector<Controller>& controllers() {
#define CRANE_CONTROLLER(name, summary, shape, tracking, anti_swing, corrects) \
  {name, summary, ReferenceShape::shape, tracking, anti_swing, corrects},
  static const std::vector<Controller> kAll{
#include "laws/registered.def"
  };
#undef CRANE_CONTROLLER
  return kAll;
}

std::vector<std::string> problems(const Controller& controller, const Design& design) {
  if (controller.make_anti_swing != make_fuzzy_generated) return {};
  const auto missing = missing_rules(generated_rules(design));
  if (missing.empty()) return {};
  constexpr std::size_t kNamed = 4;
  std::string places;
  for (std::size_t i = 0; i < std::min(kNamed, missing.size()); ++i)
    places += (i == 0 ? "" : ", ") + missing[i];
  if (missing.size() > kNamed) places += " and " + std::to_string(missing.size() - kNamed) + " more";
  return {std::string(controller.name) + ": no rule for " + places +
          ": the rules are generated from simulations of delayed_1, and no simulation with these gains and "
          "scales reaches these entries of the table; change fuzzy_swing_rad, fuzzy_swing_rate or the gains "
          "of delayed_1"};
}

const Controller* find_controller(std::string_view name) {
  const auto& all = controllers();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace crane::control
