#pragma once
/// Script and style of every page. CMake generates the definitions from third_party/ and assets/.

namespace crane::report::assets {

extern const char* const uplot_script;
extern const char* const uplot_style;
extern const char* const page_script;
extern const char* const page_style;

}  // namespace crane::report::assets
