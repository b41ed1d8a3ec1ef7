/// The score by quarters of each nuisance of the deck.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "score/score_record.hpp"

namespace crane::diagnosis::score {
namespace {

using Part = std::vector<const Record*>;

/// Least number of sets of a quarter.
constexpr std::size_t kLeastSets = 5;

bool judged_as(const Record& r, std::initializer_list<Judged> any) {
  return std::any_of(any.begin(), any.end(), [&](Judged judged) { return r.judged == name_of(judged); });
}

/// Whether the verdict is right up to a confounded group.
bool good(const Record& r) {
  if (r.kind == name_of(Kind::clean) || r.kind == name_of(Kind::outside))
    return judged_as(r, {Judged::right});
  if (r.kind == name_of(Kind::pair)) return judged_as(r, {Judged::right, Judged::beside, Judged::group});
  return judged_as(r, {Judged::right, Judged::among, Judged::group});
}

Part part_of_kind(const Part& some, Kind kind) {
  Part left;
  std::copy_if(some.begin(), some.end(), std::back_inserter(left),
               [&](const Record* r) { return r->kind == name_of(kind); });
  return left;
}

std::size_t count_good(const Part& some) {
  return static_cast<std::size_t>(
      std::count_if(some.begin(), some.end(), [](const Record* r) { return good(*r); }));
}

std::string three_digits(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

struct Worst {
  double share = 2;
  std::string where;
};

void add_row(std::ostringstream& text, const std::string& name, double low, double high, const Part& some,
             Worst& worst) {
  const Part singles = part_of_kind(some, Kind::single), clean = part_of_kind(some, Kind::clean);
  text << "| " << name << " | " << three_digits(low) << " | " << three_digits(high) << " | "
       << share(count_good(some), some.size()) << " | " << share(count_good(singles), singles.size()) << " | "
       << share(clean.size() - count_good(clean), clean.size()) << " |\n";
  const double right = static_cast<double>(count_good(some)) / static_cast<double>(some.size());
  if (some.size() >= kLeastSets && right < worst.share)
    worst = {right, name + " from " + three_digits(low) + " to " + three_digits(high)};
}

}  // namespace

std::string quarters_of(const std::vector<Record>& records) {
  std::set<std::string> names;
  for (const Record& r : records)
    for (const auto& [name, value] : r.nuisance) names.insert(name);
  if (names.empty()) return "";
  std::ostringstream text;
  text << "\nQuarters of each nuisance; right: up to a confounded group\n\n"
       << "| nuisance | from | to | right, all sets | right, one cause | false alarms "
          "|\n|---|---|---|---|---|---|\n";
  Worst worst;
  for (const std::string& name : names) {
    Part ordered;
    for (const Record& r : records)
      if (r.nuisance.contains(name) && r.judged != "no data") ordered.push_back(&r);
    const auto value = [&](const Record* r) { return r->nuisance.at(name); };
    std::stable_sort(ordered.begin(), ordered.end(),
                     [&](const Record* a, const Record* b) { return value(a) < value(b); });
    for (std::size_t q = 0; q < 4; ++q) {
      const auto at = [&](std::size_t k) {
        return ordered.begin() + static_cast<std::ptrdiff_t>(k * ordered.size() / 4);
      };
      const Part some(at(q), at(q + 1));
      if (!some.empty()) add_row(text, name, value(some.front()), value(some.back()), some, worst);
    }
  }
  if (worst.share <= 1)
    text << "\nWorst quarter: " << worst.where << ": " << std::lround(100 * worst.share) << " % right\n";
  return text.str();
}

}  // namespace crane::diagnosis::score
