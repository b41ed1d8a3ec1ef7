#include "subject.hpp"

#include <algorithm>
#include <string_view>

namespace crane::bridge::test {
namespace {

std::vector<Kind>& registered() {
  static std::vector<Kind> kinds;
  return kinds;
}

}  // namespace

RegisteredSubject::RegisteredSubject(Kind kind) { registered().push_back(std::move(kind)); }

std::vector<Kind> all_boards() {
  auto kinds = registered();
  std::ranges::sort(kinds, {}, [](const Kind& kind) { return std::string_view{kind.name}; });
  return kinds;
}

}  // namespace crane::bridge::test
