#pragma once
/// Expectation of tests whose data have one hidden cause.
#include <gtest/gtest.h>

#include <string>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

/// Expects the verdict "named" with this cause only. A fatal failure means that `found.causes` does not have
/// this one cause.
/// @param value      of the first parameter of the cause, in its unit
/// @param tolerance  of the value, in its unit
inline void expect_cause(const Diagnosis& found, const std::string& name, double value, double tolerance) {
  EXPECT_EQ(found.verdict, Verdict::named) << found.sentence;
  ASSERT_EQ(found.causes.size(), 1U) << found.sentence;
  ASSERT_EQ(found.causes[0].name, name) << found.sentence;
  EXPECT_NEAR(found.causes[0].parameters.at(0).value, value, tolerance) << found.sentence;
}

}  // namespace crane::diagnosis
