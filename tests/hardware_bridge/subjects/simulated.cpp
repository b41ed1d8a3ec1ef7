#include "../subject.hpp"

namespace crane::bridge::test {
namespace {

const RegisteredSubject kSimulated{
    {"simulated", {"simulated"}, [](const auto& rig) { return std::make_unique<SimulatedSubject>(rig); }}};

}  // namespace
}  // namespace crane::bridge::test
