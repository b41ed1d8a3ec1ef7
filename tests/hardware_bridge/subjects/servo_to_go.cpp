#include "../subject.hpp"

namespace crane::bridge::test {
namespace {

// The board "emulated" is the same driver with the same card in a separate process.
const RegisteredSubject kModel1{{"servo_to_go_model_1", {"servo_to_go", "emulated"}, [](const auto& rig) {
                                   return std::make_unique<CardSubject>(rig, 1);
                                 }}};
const RegisteredSubject kModel2{{"servo_to_go_model_2", {"servo_to_go", "emulated"}, [](const auto& rig) {
                                   return std::make_unique<CardSubject>(rig, 2);
                                 }}};

}  // namespace
}  // namespace crane::bridge::test
