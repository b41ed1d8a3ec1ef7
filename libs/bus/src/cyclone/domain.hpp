#pragma once
/// Cyclone DDS allows one configured domain per process and domain number. The buses of one process share it.
#include <dds/dds.h>

#include <string>

#include "back_end.hpp"

namespace crane::bus::cyclone {

/// @throws Error "Cyclone DDS: `what`: <reason>" when `code` is an error
dds_entity_t checked_entity(dds_entity_t code, const std::string& what);

/// Keeps a domain open. The first object creates the domain, the last object deletes it.
class Domain {
 public:
  /// @throws Error when the domain is open with other interfaces or peers
  explicit Domain(const Options& options);
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;
  ~Domain();

 private:
  std::uint32_t number_;
};

}  // namespace crane::bus::cyclone
