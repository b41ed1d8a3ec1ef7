#pragma once
/// Parses the body of POST /api/request.
#include <stdexcept>
#include <string_view>

#include "stack/operator_client.hpp"

namespace crane::dashboard {

/// what() names the field, the value and the rule.
class BadRequest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// {"kind": "reset" (with "confirm_positions"), "arm", "disarm", "stop", "estop", "home" (with "axis"),
/// "mode" (with "mode"), "move" (with "trolley_m", "slew_rad", "hoist_m") or "hold", a move without axes
/// (hold.hpp)}. @throws BadRequest
[[nodiscard]] stack::OperatorRequest operator_request_of(std::string_view body);

}  // namespace crane::dashboard
