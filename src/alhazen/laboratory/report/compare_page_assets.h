#pragma once
/// Style and script of the page of compare_page.h.

namespace alhazen {

extern const char* const kComparePageStyle;
extern const char* const kComparePageScript;

}  // namespace alhazen
