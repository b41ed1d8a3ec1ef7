#include "crane/plant/parameters.hpp"

#include "crane/plant/parameter_fields.hpp"

namespace crane::plant {

std::vector<std::string> Parameters::problems() const {
  std::vector<std::string> found;
  fields::check(*this, kParameterFields, "", found);
  return found;
}

}  // namespace crane::plant
