#include "dashboard/connection_limits.hpp"

#include <utility>

namespace crane::dashboard {

bool ConnectionLimits::admit(const std::string& address, bool foreign) {
  if (open_ >= kMostConnections) return false;
  if (foreign) {
    if (foreign_ >= kMostForeignConnections) return false;
    auto& count = of_address_[address];
    if (count >= kMostOfOneAddress) return false;
    ++count;
    ++foreign_;
  }
  ++open_;
  return true;
}

void ConnectionLimits::release(const std::string& address, bool foreign) {
  --open_;
  if (!foreign) return;
  --foreign_;
  const auto found = of_address_.find(address);
  if (--found->second == 0) of_address_.erase(found);
}

bool ConnectionLimits::reserve(std::size_t bytes) {
  if (answers_bytes_ + bytes > kMostAnswers_bytes) return false;
  answers_bytes_ += bytes;
  return true;
}

std::unique_ptr<Admission> Admission::ask(std::shared_ptr<ConnectionLimits> limits, std::string address,
                                          bool foreign) {
  if (!limits->admit(address, foreign)) return nullptr;
  return std::unique_ptr<Admission>{new Admission{std::move(limits), std::move(address), foreign}};
}

Admission::~Admission() {
  limits_->free(reserved_bytes_);
  limits_->release(address_, foreign_);
}

bool Admission::reserve(std::size_t bytes) {
  limits_->free(std::exchange(reserved_bytes_, 0));
  if (!limits_->reserve(bytes)) return false;
  reserved_bytes_ = bytes;
  return true;
}

}  // namespace crane::dashboard
