#include "study/candidate_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crane::diagnosis {

FreeParameter free_parameter(const std::string& cause, const std::string& name, double low, double high,
                             double step) {
  const plant::TermKind& kind = *plant::find_term(cause);
  const auto found = std::find_if(kind.parameters.begin(), kind.parameters.end(),
                                  [&](const plant::TermParameter& p) { return p.name == name; });
  const double null = found->default_value, lowest = std::max(low, found->low),
               highest = std::min(high, found->high);
  // Steps grow with mass and length of the load, the range of a term does not.
  const double room = std::max(highest - null, null - lowest);
  return {name, std::string{found->unit}, null, lowest, highest, std::min(step, room)};
}

Candidate amount(const std::string& cause, const std::string& axis, const std::string& parameter, double low,
                 double high, double step) {
  Candidate c;
  c.cause = cause;
  c.axis = axis;
  c.parameters = {free_parameter(cause, parameter, low, high, step)};
  const FreeParameter& p = c.parameters.front();
  c.one_sided = p.low >= p.null || p.high <= p.null;
  c.shapes = {{{c.setting({p.null + p.step})}, {p.step}}};
  c.of_amounts = [p](const Shape&, const std::vector<double>& amounts) {
    return std::vector<double>{std::clamp(p.null + amounts[0], p.low, p.high)};
  };
  return c;
}

Candidate reaching(Candidate c, const std::vector<std::vector<double>>& settings) {
  for (const auto& values : settings) c.shapes.push_back({{c.setting(values)}, {1.0}, true});
  return c;
}

Candidate shaped(const std::string& cause, const std::string& axis, const FreeParameter& size,
                 const std::vector<FreeParameter>& of_shape, const std::vector<std::vector<double>>& shapes) {
  Candidate c;
  c.cause = cause;
  c.axis = axis;
  c.one_sided = size.low >= size.null;
  c.parameters = {size};
  c.parameters.insert(c.parameters.end(), of_shape.begin(), of_shape.end());
  for (const auto& shape : shapes) {
    std::vector<double> values{size.null + size.step};
    values.insert(values.end(), shape.begin(), shape.end());
    c.shapes.push_back({{c.setting(values)}, {size.step}});
  }
  const auto parameters = c.parameters;
  c.of_amounts = [parameters](const Shape& shape, const std::vector<double>& amounts) {
    std::vector<double> values;
    for (const FreeParameter& p : parameters) values.push_back(shape.probes[0].parameters.at(p.name));
    const FreeParameter& p = parameters[0];
    values[0] = std::clamp(p.null + amounts[0], p.low, p.high);
    return values;
  };
  return c;
}

Candidate turned(const std::string& cause, const std::string& axis, const FreeParameter& size,
                 const FreeParameter& angle, const std::vector<FreeParameter>& of_shape,
                 const std::vector<std::vector<double>>& shapes) {
  Candidate c;
  c.cause = cause;
  c.axis = axis;
  c.parameters = {size, angle};
  c.parameters.insert(c.parameters.end(), of_shape.begin(), of_shape.end());
  for (const auto& shape : shapes) {
    Shape probes;
    for (const double at : {0.0, std::numbers::pi / 2}) {
      std::vector<double> values{size.step, at};
      values.insert(values.end(), shape.begin(), shape.end());
      probes.probes.push_back(c.setting(values));
      probes.amounts.push_back(size.step);
    }
    c.shapes.push_back(probes);
  }
  const auto parameters = c.parameters;
  c.of_amounts = [parameters](const Shape& shape, const std::vector<double>& amounts) {
    std::vector<double> values;
    for (const FreeParameter& p : parameters) values.push_back(shape.probes[0].parameters.at(p.name));
    values[0] = std::min(std::hypot(amounts[0], amounts[1]), parameters[0].high);
    values[1] = std::atan2(amounts[1], amounts[0]);
    return values;
  };
  return c;
}

Candidate two_amounts(const std::string& cause, const std::string& axis, std::vector<FreeParameter> both) {
  Candidate c;
  c.cause = cause;
  c.axis = axis;
  c.parameters = std::move(both);
  c.amount_count = 2;
  Shape shape;
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<double> values{c.parameters[0].null, c.parameters[1].null};
    values[i] += c.parameters[i].step;
    shape.probes.push_back(c.setting(values));
    shape.amounts.push_back(c.parameters[i].step);
  }
  c.shapes = {shape};
  const auto parameters = c.parameters;
  c.of_amounts = [parameters](const Shape&, const std::vector<double>& amounts) {
    std::vector<double> values;
    for (std::size_t i = 0; i < 2; ++i)
      values.push_back(std::clamp(parameters[i].null + amounts[i], parameters[i].low, parameters[i].high));
    return values;
  };
  return c;
}

Candidate at_once(const std::string& cause, const std::string& axis, std::vector<FreeParameter> parameters,
                  const std::vector<std::vector<double>>& settings) {
  Candidate c;
  c.cause = cause;
  c.axis = axis;
  c.parameters = std::move(parameters);
  return reaching(std::move(c), settings);
}

std::vector<double> Candidate::begin(const Shape& shape, const std::vector<double>& amounts) const {
  if (!shape.large_probe) return of_amounts(shape, amounts);
  std::vector<double> values;
  for (const FreeParameter& p : parameters) values.push_back(shape.probes[0].parameters.at(p.name));
  return values;
}

plant::TermSetting Candidate::setting(const std::vector<double>& values) const {
  plant::TermSetting term{cause, axis, {}};
  for (std::size_t i = 0; i < parameters.size(); ++i) term.parameters[parameters[i].name] = values[i];
  return term;
}

bool Candidate::permits(const std::vector<double>& values) const {
  return std::ranges::equal(values, parameters, [](double value, const FreeParameter& p) {
    return p.low <= value && value <= p.high;
  });
}

void CandidateList::add(Candidate candidate, Changes changes, InRigFile quantity) {
  candidate.drive = changes != Changes::load;
  candidate.load = changes != Changes::drive;
  candidate.changes_known_parameter = quantity == InRigFile::yes;
  std::erase_if(candidate.ringing_starts, [&](const auto& values) { return !candidate.permits(values); });
  candidates_.push_back(std::move(candidate));
}

}  // namespace crane::diagnosis
