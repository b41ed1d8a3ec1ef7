#include "search/parts.hpp"

#include <algorithm>

#include "search/compare.hpp"

namespace crane::diagnosis {

Effects without(const Effects& effects, std::size_t i) {
  Effects rest = effects;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
  return rest;
}

const Fitted* find(const std::vector<Fitted>& all, const Effects& effects) {
  const auto found = std::ranges::find_if(all, [&](const Fitted& f) { return same(f.effects, effects); });
  return found == all.end() ? nullptr : &*found;
}

void keep(std::vector<Fitted>& all, const Fitted& fitted) {
  const auto known =
      std::ranges::find_if(all, [&](const Fitted& f) { return same(f.effects, fitted.effects); });
  if (known == all.end())
    all.push_back(fitted);
  else if (less(fitted, *known))
    *known = fitted;
}

namespace {

/// The effect with its amounts at "no effect". Where this is outside the bounds, as for a second pendulum
/// without mass, the nearest bound replaces it.
Effect with_no_amount(Effect effect) {
  for (std::size_t k = 0; k < effect.candidate->amount_count; ++k) {
    const FreeParameter& amount = effect.candidate->parameters[k];
    effect.values[k] = std::clamp(amount.null, amount.low, amount.high);
  }
  return effect;
}

}  // namespace

Fitted no_worse_than_its_parts(const Study& study, const BaseModel& base, const std::vector<Fitted>& all,
                               const Fitted& given) {
  Fitted whole = given;
  if (given.effects.size() < 2) return whole;
  for (std::size_t i = 0; i < given.effects.size(); ++i) {
    const Fitted* part = find(all, without(given.effects, i));
    if (part == nullptr || !likelier_without_penalty(*part, whole)) continue;
    Effects start = part->effects;
    start.push_back(with_no_amount(given.effects[i]));
    Fitted first = first_fit(WhitenedData(study, part->nuisance), start, *part);
    first.first_nuisance = part->nuisance;  // with this noise, the start is as likely as the part
    const Fitted again = refit_with_own_noise(study, base, first);
    if (less(again, whole)) whole = again;
  }
  return whole;
}

std::vector<Fitted> merged(std::vector<Fitted> some, const std::vector<Fitted>& more) {
  some.insert(some.end(), more.begin(), more.end());
  std::sort(some.begin(), some.end(), less);
  std::vector<Fitted> once;
  for (const Fitted& fitted : some)
    if (find(once, fitted.effects) == nullptr) once.push_back(fitted);
  return once;
}

}  // namespace crane::diagnosis
