#pragma once
/// First section of the report: the verdict, and the causes with their values.
#include "crane/diagnosis/diagnosis.hpp"
#include "crane/report/page.hpp"

namespace crane::diagnosis {

[[nodiscard]] report::Section verdict_section(const Diagnosis& diagnosis);

}  // namespace crane::diagnosis
